#pragma once
// Errors of the user's input: each names file, line, element, attribute and value, says what was expected,
// and all of a file are thrown together. The program that catches InputErrors prints what() and leaves with
// exit code 2.

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace mpm::core {

/// Where in the user's files a thing was declared; line counts from 1, 0 when the whole file is meant.
struct SourceLocation {
  std::string file;
  int line = 0;
};

/// One fault about the input. Element, attribute and value may be empty when the fault is about more.
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

/// Every fault about an input, sorted by file and line. what() is the full text, one fault per line.
class InputErrors : public std::runtime_error {
 public:
  explicit InputErrors(std::vector<Diagnostic> diagnostics);
  /// A single fault about something declared at `where` (for checks made after the file was read).
  InputErrors(const SourceLocation& where, std::string element, std::string message);

  const std::vector<Diagnostic>& diagnostics() const noexcept { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

/// What several checks report, to be thrown together.
class ErrorList {
 public:
  /// Run f(); what it throws as InputErrors is kept.
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
