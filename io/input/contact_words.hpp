// The words of the input language for contact that stand for an enumeration.
#pragma once

#include <array>
#include <string_view>

namespace mpm::io {

/// Contact@contact_normal, in the order of core::ContactInput::Normal.
inline constexpr std::array<std::string_view, 3> contact_normals{"automatic", "mass_gradient", "regression"};

}  // namespace mpm::io
