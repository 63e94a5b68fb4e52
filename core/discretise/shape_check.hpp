#pragma once
// Checks that a body's input defines a shape with particles: the only place where geometry is checked. The
// input reader reports these errors together with all others, at the lines of the attributes;
// make_seed_source throws them, for scenes created in another way. Two checks need the particles themselves
// and follow their creation (core/setup/build_model.hpp): that each particle is inside the grid, and that a
// body too large to be checked here has particles. Tested by tests/core/discretise/difference_test and
// tests/io/input/shapes_test.

#include <cstddef>
#include <string>
#include <vector>

#include "core/scene/scene.hpp"

namespace mpm::core {

/// In terms of the input. `attribute` is empty for an error in the element as a whole.
struct ShapeFault {
  std::string element = "Geometry";  ///< "Body", "Geometry", or a child of Geometry: "Point", "Element"
  std::size_t child = 0;             ///< index of the "Point" or "Element", from 0
  std::string attribute;
  std::string value;
  std::string message;
};

/// The faults of one body's shape; of a Bool body's operands, only whether they can be operands. NaN values
/// cause only faults about themselves, so that a reader can omit those that it has already reported. Reads no
/// files. For an active body whose first pieces are generated quickly, also checks that it has a particle.
std::vector<ShapeFault> shape_faults(const Scene& scene, const BodyInput& body);

/// The same for a body and all its operands, located at the lines of the bodies.
std::vector<Diagnostic> shape_errors(const Scene& scene, const BodyInput& body);

/// The fault about a body that has no particles.
Diagnostic no_particles(const Scene& scene, const BodyInput& body);

/// Whether a body, or an operand that it is made of, is read from a file. The body must have no faults.
bool made_of_files(const Scene& scene, const BodyInput& body);

}  // namespace mpm::core
