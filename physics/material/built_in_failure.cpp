#include "physics/failure/list.hpp"
#include "physics/material/built_in.hpp"

namespace mpm::physics {

std::vector<FailureLawEntry> built_in_failure() { return entries_of<FailureModels>(); }

}  // namespace mpm::physics
