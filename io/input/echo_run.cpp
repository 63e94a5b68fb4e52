// Grid, solution and output as text.

#include <cmath>

#include <fmt/format.h>

#include "io/input/echo_parts.hpp"

namespace mpm::io {

namespace {

std::string_view word(core::ShapeFunction shape) {
  using enum core::ShapeFunction;
  switch (shape) {
    case linear: return "linear";
    case uniform_gimp: return "uGIMP";
    case contiguous_particle_gimp: return "cpGIMP";
    case sgmp: return "SGMP";
    case cpdi: return "CPDI";
    case cpdi2: return "CPDI2";
    case quadratic_bspline: return "QuadraticBSpline";
    case cubic_bspline: return "CubicBSpline";
    case ddmp: return "DDMP";
  }
  return {};
}

std::string_view word(core::Scheme scheme) {
  switch (scheme) {
    case core::Scheme::usf: return "USF";
    case core::Scheme::usl: return "USL";
    case core::Scheme::musl: return "MUSL";
    case core::Scheme::usavg: return "USAVG";
  }
  return {};
}

std::string_view word(core::Transfer transfer) {
  switch (transfer) {
    case core::Transfer::flip: return "FLIP";
    case core::Transfer::pic: return "PIC";
    case core::Transfer::apic: return "APIC";
    case core::Transfer::tpic: return "TPIC";
    case core::Transfer::aflip: return "AFLIP";
    case core::Transfer::xpic: return "XPIC";
    case core::Transfer::fmpm: return "FMPM";
  }
  return {};
}

void echo_cell(XmlWriter& w, const core::GridInput& grid) {
  const auto cell = w.element("Cell");
  w.text("type", grid.nonuniform ? "nonuniform" : "regular");
  for (std::size_t i = 0; i < 3; ++i) {
    const core::GridAxis& axis = grid.axes[i];
    const auto face = [&](std::string_view side, double value, core::Boundary boundary) {
      const auto scope = w.element(fmt::format("{}{}", "XYZ"[i], side));
      w.number("value", value);
      w.integer("boundary", static_cast<int>(boundary));
    };
    face("Min", axis.min, axis.lower);
    face("Max", axis.max, axis.upper);
  }
  {
    const auto size = w.element("DCell");
    w.numbers("dx", "dy", "dz", {grid.axes[0].cell_size, grid.axes[1].cell_size, grid.axes[2].cell_size});
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (const core::GridSegment& segment : grid.axes[i].segments) {
      const auto scope = w.element(fmt::format("{}Segment", "XYZ"[i]));
      w.number("end", segment.end);
      w.integer("cells", static_cast<long long>(segment.cells));
      w.number("ratio", segment.ratio);
    }
  }
  const auto moving = w.element("MovingGrid");
  w.flag("enable", grid.moving.enable);
  w.flag("consider_failure_particle", grid.moving.consider_failed_particles);
  w.number("time_step_factor", grid.moving.time_step_factor);
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::isfinite(grid.moving.min[i])) w.number(fmt::format("{}_min", "xyz"[i]), grid.moving.min[i]);
    if (std::isfinite(grid.moving.max[i])) w.number(fmt::format("{}_max", "xyz"[i]), grid.moving.max[i]);
  }
}

void echo_watches(XmlWriter& w, const core::SolutionInput& solution) {
  {
    const auto volume = w.element("Volume");
    w.integer("update_type", static_cast<int>(solution.volume.update));
    w.maybe("erode", solution.volume.erode);
    w.maybe("min", solution.volume.min);
    w.maybe("max", solution.volume.max);
  }
  {
    const auto volumetric = w.element("Volumetric");
    w.text("averaging", solution.averaging == core::VolumeAveraging::cell ? "cell" : "none");
    w.number("relaxation", solution.pressure_relaxation);
  }
  const core::WarnInput& warn = solution.warn;
  std::string types = warn.negative_internal_energy ? "|ie" : "";
  if (warn.negative_volume) types += "|vol";
  if (warn.outside_grid) types += "|grid";
  if (!types.empty()) {
    const auto scope = w.element("Warn");
    w.text("type", types.substr(1));
    w.integer("level", static_cast<int>(warn.level));
  }
  if (solution.energy_fraction) {
    const auto scope = w.element("EnergyFraction");
    w.number("value", *solution.energy_fraction);
  }
}

void echo_implicit(XmlWriter& w, const core::ImplicitInput& implicit) {
  const auto scope = w.element("Implicit");
  static constexpr std::string_view types[] = {"dynamic", "quasistatic", "semi"};
  w.text("type", types[static_cast<std::size_t>(implicit.type)]);
  static constexpr std::string_view rules[] = {"newmark", "backward_euler", "generalised_alpha"};
  w.text("rule", rules[static_cast<std::size_t>(implicit.rule)]);
  w.number("spectral_radius", implicit.spectral_radius);
  w.number("newmark_beta", implicit.newmark_beta);
  w.number("newmark_gamma", implicit.newmark_gamma);
  w.number("gravity_ramp", implicit.gravity_ramp);
  w.maybe("time_step", implicit.time_step);
  w.maybe("min_step", implicit.min_step);
  w.maybe("max_step", implicit.max_step);
  w.number("rtol", implicit.relative_tolerance);
  w.maybe("atol", implicit.absolute_tolerance);
  w.integer("max_newton", implicit.max_newton);
  w.text("jacobian", implicit.matrix_free          ? "matrixfree"
                     : implicit.difference_tangent ? "differences"
                                                   : "assembled");
  w.number("stabilisation", implicit.stabilisation);
}

void echo_fem(XmlWriter& w, const core::FemInput& fem) {
  const auto scope = w.element("FEMSetting");
  w.flag("CoupleFEM_MPM", fem.couple_with_particles);
  w.flag("FEMContact", fem.contact);
  for (const core::FemInput::RigidWall& wall : fem.rigid_walls) {
    const auto element = w.element("RigidWall");
    w.integer("RigidnDir", (wall.axis + 1) * (wall.positive_normal ? 1 : -1));
    w.number("RigidCoor", wall.coordinate);
  }
  if (fem.hourglass) {
    const auto element = w.element("Hourglass");
    w.integer("HGMethod", fem.hourglass->method);
    w.number("Qhg", fem.hourglass->coefficient);
  }
  for (const core::FixedLayer& layer : fem.fixed_layers) echo_fixed_layer(w, "GlobalBoundaryCond", layer);
}

void echo_line(XmlWriter& w, std::string_view name, const std::optional<core::LineInput>& line) {
  if (!line) return;
  const auto scope = w.element(name);
  w.integer("normal", line->normal);
  w.number("x", line->first);
  w.number("y", line->second);
}

void echo_post_processing(XmlWriter& w, const core::PostProcessingInput& post) {
  const auto scope = w.element("PostProcessing");
  w.number("time_interval", post.time_interval);
  w.flag("h5part", post.h5part);
  w.integer("vtk_data", static_cast<int>(post.vtk));
  w.flag("tecplot", post.tecplot);
  w.flag("cellresult", post.cell_result);
  w.integer("OutGridData", static_cast<int>(post.grid_data));
  w.flag("StaFragSize", post.fragments);
  w.maybe("StaFragTimeInterval", post.fragments_time_interval);
  if (!post.variables.empty()) w.text("var", fmt::format("{}", fmt::join(post.variables, "|")));
}

void echo_history(XmlWriter& w, const core::TimeHistoryInput& history) {
  const auto scope = w.element("TimeHistory");
  std::vector<std::string> words = history.variables;
  if (history.force) words.emplace_back("force");
  if (history.moment) words.emplace_back("moment");
  w.text("var", fmt::format("{}", fmt::join(words, "|")));
  const auto places = [&](std::string_view name, const std::vector<core::Vec3<double>>& list) {
    for (const core::Vec3<double>& place : list) {
      const auto element = w.element(name);
      w.numbers("x", "y", "z", place);
    }
  };
  places("Particle", history.particles);
  places("Point", history.points);
  for (const std::string& body : history.bodies) {
    const auto element = w.element("Body");
    w.text("name", body);
  }
}

}  // namespace

void echo_grid(XmlWriter& w, const core::GridInput& grid) {
  const auto scope = w.element("Grid");
  w.number("mass_cutoff", grid.mass_cutoff);
  w.text("shape", word(grid.shape));
  echo_cell(w, grid);
  const auto dynamic = w.element("DynamicCell");
  w.flag("enable", grid.dynamic_cell.enable);
  w.integer("clear_steps", grid.dynamic_cell.clear_steps);
}

void echo_solution(XmlWriter& w, const core::SolutionInput& solution) {
  const auto scope = w.element("Solution");
  w.text("algorithm", solution.automatic_scheme ? "auto" : word(solution.scheme));
  w.flag("near_boundary_stop", solution.near_boundary_stop);
  w.text("Integration", solution.integration == core::Integration::implicit ? "impl" : "expl");
  w.text("transfer", word(solution.transfer));
  w.number("flip_fraction", solution.flip_fraction);
  w.integer("xpic_order", solution.xpic_order);
  w.integer("xpic_interval", solution.xpic_interval);
  w.text("mass", solution.mass == core::MassMatrix::consistent ? "consistent" : "lumped");
  const auto value = [&](std::string_view name, std::string_view attribute, double number) {
    const auto element = w.element(name);
    w.number(attribute, number);
  };
  value("EndTime", "value", solution.end_time);
  {
    const auto step = w.element("TimeStep");
    w.number("factor", solution.time_step.factor);
    w.flag("const", solution.time_step.constant);
    w.number("specified", solution.time_step.specified);
    w.flag("NotConsiderVisForCp", solution.time_step.ignore_viscosity);
  }
  if (solution.limit_velocity) value("LimitVelocity", "max", *solution.limit_velocity);
  echo_watches(w, solution);
  value("DynamicRelax", "damping", solution.damping);
  {
    const auto gravity = w.element("Gravity");
    w.numbers("ax", "ay", "az", solution.gravity);
  }
  if (solution.fem) echo_fem(w, *solution.fem);
  if (solution.threads) {
    const auto threads = w.element("OpenMPSetting");
    w.integer("nthread", *solution.threads);
  }
  if (solution.implicit) echo_implicit(w, *solution.implicit);
}

void echo_output(XmlWriter& w, const core::OutputInput& output) {
  const auto scope = w.element("Output");
  {
    const auto console = w.element("Console");
    w.number("print_time", output.console.print_time);
    w.flag("print_momentum", output.console.print_momentum);
  }
  if (output.post_processing) echo_post_processing(w, *output.post_processing);
  for (const core::TimeHistoryInput& history : output.histories) echo_history(w, history);
  echo_line(w, "GridLineResults", output.grid_line);
  echo_line(w, "FEMProfileResults", output.fem_profile);
  if (output.restart_interval) {
    const auto restart = w.element("Restart");
    w.number("time_interval", *output.restart_interval);
  }
  {
    const auto statistics = w.element("Statistics");
    w.flag("memory", output.statistics.memory);
    w.flag("cell_occupy", output.statistics.cell_occupancy);
  }
  const auto summary = w.element("Summary");
  w.flag("enable", output.summary);
}

}  // namespace mpm::io
