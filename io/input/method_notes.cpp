#include "io/input/method_notes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/contact/component_contact.hpp"
#include "core/has_shape.hpp"

namespace mpm::io {

namespace {

/// The box of the bodies' initial velocities where these are numbers, with that of walls.
class VelocityRange {
 public:
  explicit VelocityRange(const core::Scene& scene) {
    core::for_each_active_body(scene, [&](int, const core::BodyInput& body) {
      if (body.initial_velocity_expressions.empty() && body.prescribed_velocity_expressions.empty())
        add(body.prescribed_velocity.value_or(body.initial_velocity));
    });
    for (const core::GridAxis& axis : scene.grid.axes)
      if (core::is_constrained(axis.lower) || core::is_constrained(axis.upper)) add({});
  }
  double largest_difference() const {
    const core::Vec3<double> d = highest_ - lowest_;
    return std::hypot(d.x, d.y, d.z);
  }

 private:
  void add(const core::Vec3<double>& v) {
    for (int a = 0; a < 3; ++a) {
      lowest_[a] = empty_ ? v[a] : std::min(lowest_[a], v[a]);
      highest_[a] = empty_ ? v[a] : std::max(highest_[a], v[a]);
    }
    empty_ = false;
  }
  bool empty_ = true;
  core::Vec3<double> lowest_{}, highest_{};
};

}  // namespace

void note_linear_functions(const Node& root, const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  if (scene.solution.integration != core::Integration::explicit_dynamics ||
      scene.grid.shape != core::ShapeFunction::linear)
    return;
  const std::optional<Node> grid = root.child("Grid");
  if (!grid || grid->find("shape") != nullptr) return;
  // A build without others has nothing better to offer.
  if (!core::has_shape("SGMP")) return;
  const double cells =
      VelocityRange(scene).largest_difference() * scene.solution.end_time / scene.grid.smallest_cell();
  constexpr double notable = 1;
  if (!(cells >= notable) && scene.detonations.empty()) return;
  const std::string who =
      scene.detonations.empty()
          ? fmt::format("bodies approach each other or a wall by up to {:.3g} cells", cells)
          : "explosives move what is around them across cells";
  notes.push_back(
      {scene.provenance.path,
       grid->line(),
       "Grid",
       {},
       {},
       fmt::format("linear shape functions, the default: {}; stresses scatter and energy is lost where "
                   "particles cross cells, and finer cells do not help: shape=\"SGMP\" avoids this at "
                   "about the same cost (docs/choosing.md)",
                   who)});
}

namespace {

/// What is wrong with a scene's combination of scheme, transfer and shape functions; empty: nothing is known
/// to be.
std::string_view fault_of_combination(const core::Scene& scene) {
  using core::Scheme;
  using core::ShapeFunction;
  using core::Transfer;
  const core::SolutionInput& solution = scene.solution;
  const ShapeFunction shape = scene.grid.shape;
  const bool contiguous = shape == ShapeFunction::contiguous_particle_gimp,
             fmpm = solution.transfer == Transfer::fmpm;
  if (solution.scheme == Scheme::usl && solution.transfer == Transfer::aflip && !contiguous)
    return "with algorithm USL and transfer AFLIP the energy grows at steps of any length: choose MUSL, "
           "USAVG or USF";
  if (fmpm && solution.xpic_order > 2 && shape == ShapeFunction::cpdi2)
    return "with CPDI2 and FMPM of an order above 2 the energy may grow in runs of some thousand steps: "
           "choose xpic_order=\"2\", or CPDI";
  const bool consistent = solution.mass == core::MassMatrix::consistent;
  const bool grows = (contiguous && (consistent || solution.transfer == Transfer::aflip)) ||
                     (shape == ShapeFunction::linear && consistent) ||
                     (shape == ShapeFunction::cpdi && fmpm && solution.xpic_order > 3);
  if (solution.scheme == Scheme::usf && grows)
    return "with algorithm USF, these shape functions and this mapping of velocities the energy may grow in "
           "runs of some ten thousand steps: choose USAVG";
  return {};
}

}  // namespace

void note_scheme(const Node& root, const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  const std::optional<Node> node = root.child("Solution");
  if (!node || scene.solution.integration != core::Integration::explicit_dynamics) return;
  const std::string_view fault = fault_of_combination(scene);
  if (fault.empty()) return;
  notes.push_back({scene.provenance.path,
                   node->line(),
                   "Solution",
                   {},
                   {},
                   fmt::format("{} (docs/stability.md)", fault)});
}

void note_soft_drivers(const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  if (scene.solution.integration != core::Integration::explicit_dynamics) return;
  const core::BodyInput* driver = nullptr;
  int bodies = 0;
  core::for_each_active_body(scene, [&](int, const core::BodyInput& body) {
    ++bodies;
    const bool drives = body.prescribed_velocity || body.constrain_rigid_position;
    if (drives && driver == nullptr && !core::is_rigid(scene.materials[body.material])) driver = &body;
  });
  if (driver == nullptr || bodies < 2) return;
  notes.push_back(
      {driver->source.file,
       driver->source.line,
       "Body",
       {},
       {},
       fmt::format("body '{}' has a prescribed velocity and a deformable material: explicit steps "
                   "prescribe it to the particles, not to the nodes, so that it presses on other "
                   "bodies with its own stiffness and they may enter it; choose a material a "
                   "hundred times stiffer than theirs, or Rigid with Contact",
                   driver->name)});
}

void note_free_axes(const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  const core::SolutionInput& solution = scene.solution;
  if (solution.integration != core::Integration::implicit || !solution.implicit ||
      !solution.implicit->quasistatic())
    return;
  bool held[3] = {false, false, false}, all = false;
  core::for_each_active_body(scene, [&](int, const core::BodyInput& body) {
    all = all || body.prescribed_velocity || !body.fixed_layers.empty();
  });
  for (std::size_t a = 0; a < 3; ++a) {
    for (const core::Boundary face : {scene.grid.axes[a].lower, scene.grid.axes[a].upper}) {
      all = all || face == core::Boundary::fixed;
      held[a] = held[a] || face == core::Boundary::symmetry;
    }
  }
  std::vector<std::string> free;
  for (std::size_t a = 0; a < 3; ++a)
    if (!held[a]) free.emplace_back(1, "xyz"[a]);
  if (all || free.empty()) return;
  notes.push_back(
      {scene.provenance.path,
       scene.grid.source.line,
       "Grid",
       {},
       {},
       fmt::format("no symmetry plane, fixed face or body of prescribed velocity holds the bodies along {}: "
                   "in quasi-static steps, which have no inertia, they may drift there",
                   fmt::join(free, " and "))});
}

}  // namespace mpm::io
