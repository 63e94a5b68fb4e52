#include "io/input/diagnostics.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace mpm::io {

void Diagnostics::add(int line, std::string_view element, std::string_view attribute, std::string_view value,
                      std::string message) {
  constexpr std::size_t readable = 1000;
  if (found_.size() >= readable) {
    ++left_out_;
    return;
  }
  found_.push_back(
      {file_, line, std::string(element), std::string(attribute), std::string(value), std::move(message)});
}

void Diagnostics::merge(const Diagnostics& other) {
  const std::vector<core::Diagnostic> mine = found_;
  for (const core::Diagnostic& d : other.found_) {
    const auto same = [&](const core::Diagnostic& m) {
      return m.line == d.line && m.element == d.element && m.attribute == d.attribute;
    };
    if (std::ranges::none_of(mine, same)) found_.push_back(d);
  }
  left_out_ += other.left_out_;
}

void Diagnostics::raise_if_any() {
  if (found_.empty()) return;
  std::ranges::stable_sort(found_, {}, &core::Diagnostic::line);
  if (left_out_ > 0) found_.push_back({file_, 0, {}, {}, {}, fmt::format("and {} more", left_out_)});
  throw core::InputErrors(std::move(found_));
}

}  // namespace mpm::io
