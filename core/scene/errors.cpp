#include "core/scene/errors.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace mpm::core {

namespace {

/// On one line and of readable length, for any content of the file.
std::string shown(const std::string& value) {
  constexpr std::size_t longest = 120;
  std::size_t cut = std::min(value.size(), longest);
  while (cut < value.size() && cut > 0 && (static_cast<unsigned char>(value[cut]) & 0xC0) == 0x80) --cut;
  std::string text = value.substr(0, cut);
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return cut < value.size() ? text + "..." : text;
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
