// From the checked document to the scene, one function per part. Each reports faults beyond the
// Specification: unresolved names, bounds in the wrong order, invalid shapes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "core/scene/scene.hpp"
#include "io/input/diagnostics.hpp"
#include "io/input/node.hpp"

namespace mpm::io {

struct BuildContext {
  Diagnostics& diagnostics;
  std::filesystem::path folder;  ///< of the input, for relative paths
  bool check_files = true;

  core::SourceLocation at(const Node& node) const { return {diagnostics.file(), node.line()}; }
};

core::HeaderInput build_header(const Node& root);
std::vector<core::MaterialInput> build_materials(const Node& root, const BuildContext& context);
std::vector<core::FrictionPair> build_frictions(const Node& root,
                                                const std::vector<core::MaterialInput>& materials,
                                                const BuildContext& context);
std::vector<core::WorkPlane> build_work_planes(const Node& root, const BuildContext& context);
/// Uses the materials, work planes, grid and contact of `scene`.
std::vector<core::ComponentInput> build_components(const Node& root, const core::Scene& scene,
                                                   const BuildContext& context);
/// Reports invalid shapes of bodies (core/discretise/shape_check.hpp).
void check_shapes(const Node& root, const core::Scene& scene, const BuildContext& context);
/// All alternatives but BoolGeometry, whose operands are bodies.
core::Geometry build_geometry(const Node& geometry, const BuildContext& context);
std::vector<core::DetonationItem> build_detonations(const Node& root, const BuildContext& context);
core::GridInput build_grid(const Node& root, const BuildContext& context);
core::ContactInput build_contact(const Node& root);
core::SolutionInput build_solution(const Node& root, const BuildContext& context);
/// Reports incompatible choices of shape function, transfer and bodies.
void check_method(const Node& root, const core::Scene& scene, const BuildContext& context);
/// Reports what contact cannot do.
void check_contact(const Node& root, const core::Scene& scene, const BuildContext& context);
/// What implicit steps cannot do.
void check_implicit(const Node& root, const core::Scene& scene, const BuildContext& context);
/// Uses the bodies, contact and solution of `scene`.
core::OutputInput build_output(const Node& root, const core::Scene& scene, const BuildContext& context);
core::DecompositionInput build_decomposition(const Node& root, const BuildContext& context);
core::FixedLayer build_fixed_layer(const Node& node, const BuildContext& context);

/// Index of the name that the attribute of `node` refers to; reports a fault and returns nullopt if there is
/// none.
std::optional<std::size_t> resolve(const Node& node, std::string_view attribute, std::string_view kind,
                                   const std::vector<std::string_view>& names, const BuildContext& context);

template <class Item>
std::vector<std::string_view> names_of(const std::vector<Item>& items) {
  std::vector<std::string_view> names;
  for (const Item& item : items) names.emplace_back(item.name);
  return names;
}

/// Reports every item of `nodes` whose name is already used.
void check_unique_names(const std::vector<Node>& nodes, std::string_view kind, const BuildContext& context);

}  // namespace mpm::io
