#pragma once
// The scene: the contents of an input file, checked and with every default filled in, as plain structs. It
// contains no particles and no file format; `io` creates it, `core` discretises it. Units are the user's own
// and consistent; vectors are in the global frame unless a work plane is given.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/body.hpp"
#include "core/scene/errors.hpp"
#include "core/scene/geometry.hpp"
#include "core/scene/grid.hpp"
#include "core/scene/material.hpp"
#include "core/scene/output.hpp"
#include "core/scene/solution.hpp"

namespace mpm::core {

/// The user's description of the case; copied to every output.
struct HeaderInput {
  std::string name;
  std::string heading;
  std::string description;
  std::string time_unit;
  std::string length_unit;
  std::string mass_unit;
};

/// The source of the scene.
struct Provenance {
  std::string path;      ///< as given by the user
  std::string job_name;  ///< the file's name without folder and `.xmp`
  std::string hash;      ///< 16 hexadecimal digits: FNV-1a, 64 bit, of the file's bytes
};

enum class PartitionMethod { automatic, uniform, metis };

struct DecompositionInput {
  std::optional<std::array<int, 3>> dimensions;  ///< their product must equal the number of ranks
  /// `uniform` when dimensions are given and no method is; `automatic` when neither is.
  PartitionMethod method = PartitionMethod::automatic;
  std::optional<int> rebalance_interval;  ///< steps; automatic without
  double imbalance_tolerance = 1.05;      ///< > 1
  SourceLocation source;
};

struct Scene {
  HeaderInput header;
  std::vector<MaterialInput> materials;
  std::vector<FrictionPair> frictions;
  std::vector<WorkPlane> work_planes;
  std::vector<ComponentInput> components;
  std::vector<DetonationItem> detonations;
  GridInput grid;
  ContactInput contact;
  SolutionInput solution;
  OutputInput output;
  DecompositionInput decomposition;
  Provenance provenance;
  /// A deformable body has about one particle in a cell, with functions whose gradients jump at the faces of
  /// cells: linear and DDMP.
  bool has_single_particles = false;
};

/// Whether failed particles form a component of their own.
inline bool has_failed_component(const Scene& scene) {
  return scene.contact.enable && scene.contact.failed_to_component;
}
/// Its number, where components are counted as in Scene::components.
inline std::int32_t failed_component(const Scene& scene) {
  return static_cast<std::int32_t>(scene.components.size());
}
/// Of the scene's components, with that of failed particles.
inline std::size_t component_count(const Scene& scene) {
  return scene.components.size() + (has_failed_component(scene) ? 1 : 0);
}

/// Throws std::out_of_range if there is no body at `place`.
inline const BodyInput& body_at(const Scene& scene, BodyPlace place) {
  return scene.components.at(place.component).bodies.at(place.body);
}

/// The active bodies, in the order of the input, with the numbers of their components.
template <class F>
void for_each_active_body(const Scene& scene, F f) {
  for (std::size_t c = 0; c < scene.components.size(); ++c) {
    for (const BodyInput& body : scene.components[c].bodies) {
      if (!body.deactivated && !body.for_bool) f(static_cast<int>(c), body);
    }
  }
}
inline bool has_surface_loads(const Scene& scene) {
  bool found = false;
  for_each_active_body(scene, [&](int, const BodyInput& b) { found = found || !b.surface_loads.empty(); });
  return found;
}
inline std::vector<const BodyInput*> active_bodies(const Scene& scene) {
  std::vector<const BodyInput*> bodies;
  for_each_active_body(scene, [&](int, const BodyInput& b) { bodies.push_back(&b); });
  return bodies;
}

}  // namespace mpm::core
