// What every program says of laws from outside that the registry has refused.
#pragma once

#include <cstdio>

#include "physics/registry.hpp"

namespace mpm::apps {

/// Prints what is wrong with the registry's laws; true where anything is.
inline bool say_faults(const physics::Registry& registry, bool speak) {
  if (speak) {
    for (const std::string& fault : registry.faults()) std::fprintf(stderr, "%s\n", fault.c_str());
  }
  return !registry.faults().empty();
}

}  // namespace mpm::apps
