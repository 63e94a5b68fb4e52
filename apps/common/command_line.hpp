// The command line of a program: options and flags by name, help and version made of them, every value
// checked.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace mpm::apps {

/// What a number must be besides a number.
enum class Range { any, positive };

class CommandLine {
 public:
  /// `program` is the name in the help; the name that it was called by without.
  explicit CommandLine(const std::string& description, const std::string& program = {});
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// An option with a value, "-p,--path", or, without a dash, a word by its place. What `value` holds is the
  /// default, shown in the help with `show_default`. A list takes every word by its place, or one value each
  /// time it is named.
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
  /// The same for a word that must be given.
  void required(const std::string& names, std::string& value, const std::string& help);
  void flag(const std::string& names, bool& value, const std::string& help);

  void version(const std::string& text);
  void footer(const std::string& text);

  /// Nothing where all is well; or the code to leave with, 0 after help or version, 2 after wrong usage, said
  /// on standard output or standard error where `speak`.
  std::optional<int> parse(const std::vector<std::string>& words, bool speak = true);
  std::optional<int> parse(int argc, char** argv);

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace mpm::apps
