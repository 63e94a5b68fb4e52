#include "io/output/narrowing.hpp"

#include <span>

#include <fmt/format.h>

namespace mpm::io {

namespace {

void list(std::string& text, const std::string& name, std::int64_t count) {
  text += fmt::format("{}{} value(s) of {}", text.empty() ? "" : ", ", count, name);
}

}  // namespace

std::string CutValues::warning(const std::string& file, std::int64_t step,
                               const std::vector<std::string>& names, std::vector<std::int64_t> mine,
                               core::Reductions& ranks) {
  ranks.sum(std::span<std::int64_t>(mine));
  std::string found;
  bool is_new = false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (mine[i] == 0) continue;
    list(found, names[i], mine[i]);
    is_new = counts_.try_emplace(names[i], 0).second || is_new;
    counts_[names[i]] += mine[i];
  }
  if (!is_new) return {};
  return fmt::format(
      "step {}: out of the range of numbers in '{}': {}; written as the largest number of their type: choose "
      "units in which the values are smaller",
      step, file, found);
}

std::string CutValues::total(const std::string& file) const {
  std::string found;
  for (const auto& [name, count] : counts_) list(found, name, count);
  return found.empty() ? found
                       : fmt::format("{} in '{}', cut to the largest number of their type", found, file);
}

}  // namespace mpm::io
