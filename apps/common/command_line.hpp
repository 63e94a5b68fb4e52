// The command line of a program: options and flags with checked values, and the help and version made from
// them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace mpm::apps {

/// Range of a number.
enum class Range { any, positive };

class CommandLine {
 public:
  /// `program` is the name in the help; by default the name by which it was called.
  explicit CommandLine(const std::string& description, const std::string& program = {});
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// An option with a value, "-p,--path", or, without a dash, a positional argument. `value` holds the
  /// default, which the help shows with `show_default`. A list takes all positional arguments, or one value
  /// per occurrence of the option.
  void option(const std::string& names, std::string& value, const std::string& help,
              bool show_default = false);
  void option(const std::string& names, std::optional<std::string>& value, const std::string& help);
  void option(const std::string& names, std::vector<std::string>& values, const std::string& help);
  void option(const std::string& names, int& value, const std::string& help, Range range,
              bool show_default = false);
  void option(const std::string& names, std::optional<long>& value, const std::string& help, Range range);
  void option(const std::string& names, double& value, const std::string& help, Range range,
              bool show_default = false);
  void option(const std::string& names, std::optional<double>& value, const std::string& help, Range range);
  /// A required argument.
  void required(const std::string& names, std::string& value, const std::string& help);
  void flag(const std::string& names, bool& value, const std::string& help);

  void version(const std::string& text);
  void footer(const std::string& text);

  /// Nullopt to continue, else the exit code: 0 after help or version, 2 after wrong usage. Prints on
  /// standard output or standard error only if `speak`.
  std::optional<int> parse(const std::vector<std::string>& words, bool speak = true);
  std::optional<int> parse(int argc, char** argv);

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace mpm::apps
