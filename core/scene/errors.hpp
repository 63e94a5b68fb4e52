#pragma once
// Errors in the user's input: each states file, line, element, attribute, value and the expected value; all
// errors of a file are thrown together. The program that catches InputErrors prints what() and exits with
// code 2.

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace mpm::core {

/// Where in the user's files something was declared; lines count from 1, 0 stands for the whole file.
struct SourceLocation {
  std::string file;
  int line = 0;
};

/// One error in the input. Element, attribute and value may be empty when the error is not specific to them.
struct Diagnostic {
  std::string file;
  int line = 0;
  std::string element;
  std::string attribute;
  std::string value;
  std::string message;  ///< what was expected, and the remedy
};

/// `file:line: <Element attribute="value">: message`
std::string to_text(const Diagnostic& diagnostic);

/// All errors of an input, sorted by file and line. what() is the full text, one error per line.
class InputErrors : public std::runtime_error {
 public:
  explicit InputErrors(std::vector<Diagnostic> diagnostics);
  /// A single error about something declared at `where` (for checks after the file was read).
  InputErrors(const SourceLocation& where, std::string element, std::string message);

  const std::vector<Diagnostic>& diagnostics() const noexcept { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

/// The errors of several checks, to be thrown together.
class ErrorList {
 public:
  /// Runs f() and keeps the InputErrors that it throws.
  template <class F>
  void collect(F f) {
    try {
      f();
    } catch (const InputErrors& errors) {
      found_.insert(found_.end(), errors.diagnostics().begin(), errors.diagnostics().end());
    }
  }
  void add(Diagnostic diagnostic) { found_.push_back(std::move(diagnostic)); }
  /// Throws InputErrors if there are any.
  void raise_if_any() {
    if (!found_.empty()) throw InputErrors(std::move(found_));
  }

 private:
  std::vector<Diagnostic> found_;
};

}  // namespace mpm::core
