#pragma once
// Whether what the input states of a body makes a shape with particles: the one place where geometry is
// checked. The reader of the input reports what is found here with all else that is wrong in an input, at the
// lines of the attributes; make_seed_source throws it, for scenes that were made in another way. Two checks
// need the particles themselves and come when these are made (core/setup/build_model.hpp): that each lies in
// the grid, and that a body too large to be tried here has any. Shown by
// tests/core/discretise/difference_test and tests/io/input/shapes_test.

#include <cstddef>
#include <string>
#include <vector>

#include "core/scene/scene.hpp"

namespace mpm::core {

/// In the input's names. `attribute` is empty where the element as a whole is meant.
struct ShapeFault {
  std::string element = "Geometry";  ///< "Body", "Geometry", or a child of Geometry: "Point", "Element"
  std::size_t child = 0;             ///< which "Point" or "Element" it is, from 0
  std::string attribute;
  std::string value;
  std::string message;
};

/// What is wrong with the shape of one body; nothing about the operands of a Bool body but whether they can
/// be operands. Values that are NaN bring faults about themselves alone, so that a reader can leave out
/// what it has said already. Reads no files. Of a body that takes part, and whose first pieces are soon made,
/// also whether it has any particle.
std::vector<ShapeFault> shape_faults(const Scene& scene, const BodyInput& body);

/// The same about a body and the operands that it is made of, placed at the lines of the bodies.
std::vector<Diagnostic> shape_errors(const Scene& scene, const BodyInput& body);

/// The fault about a body that has no particles.
Diagnostic no_particles(const Scene& scene, const BodyInput& body);

/// Whether a body, or an operand that it is made of, is read from a file. The body must have no faults.
bool made_of_files(const Scene& scene, const BodyInput& body);

}  // namespace mpm::core
