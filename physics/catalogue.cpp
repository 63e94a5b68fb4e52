#include "physics/catalogue.hpp"

#include "physics/registry.hpp"

namespace mpm::physics {

core::Catalogue catalogue() { return built_in_laws().catalogue(); }

}  // namespace mpm::physics
