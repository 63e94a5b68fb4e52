#include "physics/material/built_in.hpp"
#include "physics/strength/list.hpp"

namespace mpm::physics {

std::vector<StrengthLawEntry> built_in_strength() { return entries_of<StrengthModels>(); }

}  // namespace mpm::physics
