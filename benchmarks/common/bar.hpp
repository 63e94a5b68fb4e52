// The copper Taylor bar (thesis 3.5.1, table 3.1) of a given approximate number of particles, eight per cell,
// as an input text and as a run in memory. Units: mm, g, ms; stress MPa.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "apps/common/case.hpp"
#include "core/communication/solo.hpp"
#include "core/setup/build_model.hpp"
#include "core/setup/prepare_model.hpp"
#include "core/step/node_update.hpp"
#include "core/step/stepper.hpp"
#include "io/input/reader.hpp"
#include "io/output/variables.hpp"
#include "physics/catalogue.hpp"
#include "physics/material/material.hpp"

namespace mpm::benchmarks {

inline constexpr double bar_length = 25.4, bar_diameter = 7.6;

/// Particle spacing of a bar of about this many particles.
inline double bar_spacing(double particles) {
  return std::cbrt(std::numbers::pi / 4 * bar_diameter * bar_diameter * bar_length / particles);
}

inline constexpr const char* iso_harden =
    R"(<StrengthModel type="IsoHarden" Young="117e3" Poisson="0.35" Yield0="157" TangMod="423.461758"/>)";
inline constexpr const char* gruneisen =
    R"(<EquationOfState type="Gruneisen" C0="3940" S1="1.49" gamma0="1.96"/>)";

/// Material of the bar and settings of the run, as elements of the input.
struct BarInput {
  double particles = 20000;
  std::string scheme = "MUSL";
  double box = 1;  ///< times as many cells along each axis, the bar where it was among the bricks
  std::string strength = iso_harden, eos = gruneisen, failure{};
  std::string body{}, solution{}, output{}, more{};      ///< more elements
  std::string grid_attributes{}, solution_attributes{};  ///< as they stand in the element
  std::string velocity = R"(<InitialVelocity vx="0" vy="0" vz="-190"/>)";
  std::string time_step = R"(<TimeStep factor="0.4"/>)";
  int foot = 2;             ///< boundary type of the face that the bar stands on
  int bodies = 1;           ///< slices along the axis, each a body
  bool components = false;  ///< each slice in a component of its own

  std::string text() const {
    const double dp = bar_spacing(particles), cell = 2 * dp;
    // Whole bricks on each side of the axis, wide enough for the foot to spread.
    const double half = 4 * std::ceil(1.1 * bar_diameter / (4 * cell)) * cell;
    const double height = 4 * std::ceil((bar_length / cell + 1) / 4) * cell;
    std::string t =
        R"(<?xml version="1.0" encoding="utf-8"?><PeneBlast version="1.0"><Header><Name value="bar"/></Header>)";
    t += fmt::format(R"(<Material name="copper"><ReferenceDensity value="8.93e-3"/>{}{}{}</Material>)",
                     strength, eos, failure);
    if (!components) t += R"(<Component name="bar">)";
    // Slices end between layers of particles.
    const double layers = std::round(bar_length / dp);
    for (int i = 0; i < bodies; ++i) {
      const double low = i == 0 ? 0 : dp * std::round(layers * i / bodies);
      const double high = i + 1 == bodies ? bar_length : dp * std::round(layers * (i + 1) / bodies);
      if (components) t += fmt::format(R"(<Component name="bar{}">)", i);
      t += fmt::format(R"(<Body name="bar{}" material="copper" type="Cylinder">)", i);
      t += fmt::format(R"(<Geometry x0="0" y0="0" z0="{0}" dp_bottom="{1}" dp_top="{1}" )", low, dp);
      t += fmt::format(R"(Bottom_Outer_Radius="{0}" Top_Outer_Radius="{0}" height="{1}"/>{2}{3}</Body>)",
                       bar_diameter / 2, high - low, velocity, body);
      if (components) t += "</Component>";
    }
    if (!components) t += "</Component>";
    t += fmt::format(R"(<Grid {}><Cell type="regular">)", grid_attributes);
    for (const char* axis : {"X", "Y"}) {
      t += fmt::format(R"(<{0}Min value="{1}" boundary="0"/><{0}Max value="{2}" boundary="0"/>)", axis,
                       -half * box, half * box);
    }
    t += fmt::format(R"(<ZMin value="0" boundary="{}"/><ZMax value="{}" boundary="0"/>)", foot, height * box);
    t += fmt::format(R"(<DCell dx="{0}" dy="{0}" dz="{0}"/></Cell></Grid>)", cell);
    t += fmt::format(R"(<Solution algorithm="{}" {}><EndTime value="0.08"/>{}{}</Solution>)", scheme,
                     solution_attributes, time_step, solution);
    t += fmt::format(R"(<Output><Console print_time="0.08"/>{}</Output>{}</PeneBlast>)", output, more);
    return t;
  }
  core::Scene scene() const { return io::parse_scene(text(), "bar.xmp", physics::catalogue()); }
};

/// The same scene without an end, so that a measurement may run as long as it needs.
inline core::Scene endless(core::Scene scene) {
  scene.solution.end_time = 1e9;
  return scene;
}

/// A case in memory, ready to step; on one rank unless the communication says otherwise.
struct BarRun {
  std::shared_ptr<const core::Scene> scene;
  core::Model model;
  core::SoloCommunication alone;
  std::optional<core::Stepper> stepper;

  explicit BarRun(const BarInput& input) : BarRun(input.scene()) {}
  explicit BarRun(core::Scene of) : BarRun(std::move(of), nullptr) {}
  /// Collective.
  BarRun(core::Scene of, core::Communication& communication) : BarRun(std::move(of), &communication) {}
  BarRun(const BarRun&) = delete;
  BarRun& operator=(const BarRun&) = delete;

  double particles() const { return static_cast<double>(model.local_particles()); }
  double state_bytes() const {
    double bytes = 0;
    for (const core::BlockPool* pool : core::pools_of(model)) {
      bytes += static_cast<double>(pool->blocks_in_use()) * pool->layout().block_doubles() * sizeof(double);
    }
    return bytes;
  }
  /// Nodes of the bricks in use: their arrays, and what MUSL, XPIC and FMPM keep between passes.
  double brick_bytes() const { return static_cast<double>(model.grid->owned()) * node_bytes_per_brick(); }
  double node_bytes_per_brick() const {
    int doubles = core::record_doubles(core::NodeArray::first) +
                  core::record_doubles(core::NodeArray::second) +
                  (core::maps_back(scene->solution.scheme) ? core::motion_width : 0);
    if (model.grid->arrays().has(core::NodeArray::third))
      doubles += core::record_doubles(core::NodeArray::third) + core::node_doubles;
    return static_cast<double>(doubles) * sizeof(double) * model.grid->shape().nodes();
  }

 private:
  BarRun(core::Scene of, core::Communication* others)
      : scene(std::make_shared<const core::Scene>(std::move(of))),
        model(core::prepare_model(scene, physics::make_materials(*scene), io::columns_for(scene->output))) {
    core::Communication& communication = others != nullptr ? *others : alone;
    core::build_model(model, communication);
    stepper.emplace(model, communication);
  }
};

}  // namespace mpm::benchmarks
