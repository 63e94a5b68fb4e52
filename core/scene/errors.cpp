#include "core/scene/errors.hpp"

#include <fmt/format.h>

namespace mpm::core {

namespace {

/// On one line and of readable length, whatever the file held.
std::string shown(const std::string& value) {
  constexpr std::size_t longest = 120;
  std::string text;
  for (const char c : value.substr(0, longest)) text += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  return value.size() > longest ? text + "..." : text;
}

std::string join(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics) {
    if (!text.empty()) text += '\n';
    text += to_text(d);
  }
  return text;
}

}  // namespace

std::string to_text(const Diagnostic& d) {
  std::string text = d.file;
  if (d.line > 0) text += fmt::format("{}{}", text.empty() ? "line " : ":", d.line);
  if (!text.empty()) text += ": ";
  if (!d.element.empty()) {
    text += '<' + shown(d.element);
    if (!d.attribute.empty()) text += fmt::format(" {}=\"{}\"", shown(d.attribute), shown(d.value));
    text += ">: ";
  }
  return text + d.message;
}

InputErrors::InputErrors(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(join(diagnostics)), diagnostics_(std::move(diagnostics)) {}

InputErrors::InputErrors(const SourceLocation& where, std::string element, std::string message)
    : InputErrors({Diagnostic{where.file, where.line, std::move(element), {}, {}, std::move(message)}}) {}

}  // namespace mpm::core
