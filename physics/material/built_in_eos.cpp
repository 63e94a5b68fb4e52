#include "physics/eos/list.hpp"
#include "physics/material/built_in.hpp"

namespace mpm::physics {

std::vector<EosLawEntry> built_in_eos() { return entries_of<EquationsOfState>(); }

}  // namespace mpm::physics
