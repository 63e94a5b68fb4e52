// Reports the laws that the registry has refused.
#pragma once

#include <cstdio>

#include "physics/registry.hpp"

namespace mpm::apps {

/// Prints the faults of the registry's laws; true if there are any.
inline bool say_faults(const physics::Registry& registry, bool speak) {
  if (speak) {
    for (const std::string& fault : registry.faults()) std::fprintf(stderr, "%s\n", fault.c_str());
  }
  return !registry.faults().empty();
}

}  // namespace mpm::apps
