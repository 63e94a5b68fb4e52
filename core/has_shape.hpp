// Which shape functions this build has.
#pragma once

#include <algorithm>
#include <iterator>
#include <string_view>

#include "core/built.hpp"

namespace mpm::core {

/// Whether this build has the shape functions of this name in the input language.
constexpr bool has_shape(std::string_view name) {
  return std::ranges::find(built_shapes, name) != std::ranges::end(built_shapes);
}

}  // namespace mpm::core
