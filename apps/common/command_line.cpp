#include "apps/common/command_line.hpp"

#include <iostream>
#include <sstream>

#include <CLI/CLI.hpp>

namespace mpm::apps {

namespace {

/// The check of CLI11 prints the largest double in full.
const CLI::Validator& more_than_zero() {
  static const CLI::Validator validator(
      [](const std::string& word) {
        double number = 0;
        const bool good = CLI::detail::lexical_cast(word, number) && number > 0;
        return good ? std::string() : "'" + word + "' is not a number above 0";
      },
      "NUMBER > 0");
  return validator;
}

}  // namespace

struct CommandLine::Parser {
  CLI::App app;

  template <class T>
  CLI::Option* add(const std::string& names, T& value, const std::string& help, Range range = Range::any,
                   bool show_default = false) {
    CLI::Option* option = app.add_option(names, value, help);
    if (range == Range::positive) option->check(more_than_zero());
    if (show_default) option->capture_default_str();
    return option;
  }
};

CommandLine::CommandLine(const std::string& description, const std::string& program)
    : parser_(new Parser{CLI::App(description, program)}) {}
CommandLine::~CommandLine() = default;

void CommandLine::option(const std::string& names, std::string& value, const std::string& help,
                         bool show_default) {
  parser_->add(names, value, help, Range::any, show_default);
}

void CommandLine::option(const std::string& names, std::optional<std::string>& value,
                         const std::string& help) {
  parser_->add(names, value, help);
}

void CommandLine::option(const std::string& names, std::vector<std::string>& values,
                         const std::string& help) {
  CLI::Option* option = parser_->add(names, values, help);
  if (!option->get_positional()) option->allow_extra_args(false);
}

void CommandLine::option(const std::string& names, int& value, const std::string& help, Range range,
                         bool show_default) {
  parser_->add(names, value, help, range, show_default);
}

void CommandLine::option(const std::string& names, std::optional<long>& value, const std::string& help,
                         Range range) {
  parser_->add(names, value, help, range);
}

void CommandLine::option(const std::string& names, double& value, const std::string& help, Range range,
                         bool show_default) {
  parser_->add(names, value, help, range, show_default);
}

void CommandLine::option(const std::string& names, std::optional<double>& value, const std::string& help,
                         Range range) {
  parser_->add(names, value, help, range);
}

void CommandLine::required(const std::string& names, std::string& value, const std::string& help) {
  parser_->add(names, value, help)->required();
}

void CommandLine::flag(const std::string& names, bool& value, const std::string& help) {
  parser_->app.add_flag(names, value, help);
}

void CommandLine::version(const std::string& text) { parser_->app.set_version_flag("--version", text); }

void CommandLine::footer(const std::string& text) { parser_->app.footer(text); }

std::optional<int> CommandLine::parse(const std::vector<std::string>& words, bool speak) {
  try {
    parser_->app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    return {};
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, err;
    const int code = parser_->app.exit(error, out, err);
    if (speak) {
      std::cout << out.str() << std::flush;
      std::cerr << err.str() << std::flush;
    }
    return code == 0 ? 0 : 2;
  }
}

std::optional<int> CommandLine::parse(int argc, char** argv) {
  return parse(std::vector<std::string>(argv + 1, argv + argc));
}

}  // namespace mpm::apps
