#include "core/scene/material.hpp"

#include <stdexcept>

namespace mpm::core {

double LawInput::at(std::string_view name) const {
  const auto found = values.find(name);
  if (found == values.end()) throw std::logic_error(type + " has no value '" + std::string(name) + "'");
  return found->second;
}

double LawInput::value_or(std::string_view name, double otherwise) const {
  const auto found = values.find(name);
  return found == values.end() ? otherwise : found->second;
}

}  // namespace mpm::core
