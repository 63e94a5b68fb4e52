#include "apps/common/case.hpp"

#include <filesystem>

#include <fmt/format.h>

#include "io/input/echo.hpp"
#include "io/input/reader.hpp"
#include "io/output/file.hpp"
#include "io/output/job_lock.hpp"
#include "io/output/variables.hpp"
#include "io/restart/restart.hpp"
#include "parallel/communication.hpp"
#include "parallel/implicit/solver_library.hpp"
#include "parallel/launch.hpp"
#include "physics/material/material.hpp"

namespace mpm::apps {

namespace {

bool is_restart(const std::string& job) { return std::filesystem::path(job).extension() == ".pe"; }

/// The file itself or, for `Job.pe`, the newest complete restart file, after the run that writes them has
/// ended. Collective.
std::string find_restart(const RunOptions& options, const parallel::Communicator& world) {
  namespace fs = std::filesystem;
  const std::string& named = options.job;
  const bool only_reads = options.dry_run || options.to_h5part;
  parallel::MpiCommunication communication(world);
  if (communication.reductions.any(world.rank() == 0 && fs::exists(named))) return named;
  const fs::path path(named);
  const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
  std::vector<std::string> notices;
  const auto newest_of = [&](const std::string& job) {
    if (world.rank() == 0 && !only_reads) io::JobLock::wait_for(folder + "/" + job + ".lock");
    return io::find_newest_restart(folder, job, communication, notices);
  };
  const std::string job = path.stem().string();
  const auto newest = newest_of(job);
  // `Job_17.pe` may name a job `Job_17` as well as a step of `Job`.
  const auto sibling =
      newest || io::job_of_restart(named) == job ? newest : newest_of(io::job_of_restart(named));
  if (world.rank() == 0) {
    for (const std::string& notice : notices) std::fprintf(stderr, "%s\n", notice.c_str());
  }
  if (newest) return *newest;
  throw io::FileError("cannot read " + named + ": no such file" +
                      (sibling ? "; the newest restart file of the job is " + *sibling
                               : "; no readable restart file of the job was found"));
}

Case parsed(const std::string& bytes, const std::string& path, const core::Catalogue& catalogue) {
  Case c;
  c.bytes = bytes;
  c.scene = std::make_shared<const core::Scene>(
      io::parse_scene(bytes, path, catalogue, {.check_files = false, .notes = &c.notes}));
  return c;
}

/// The bytes of an input file that rank 0 has checked. Collective.
Case from_input(const std::string& job, const parallel::Communicator& world,
                const core::Catalogue& catalogue) {
  std::string path;
  std::string bytes = parallel::on_root_then_all<io::FileError>(world, [&] {
    path = io::find_input(job).string();
    std::string read = io::read_bytes(path);
    io::parse_scene(read, path, catalogue);
    return read;
  });
  return parsed(bytes, parallel::broadcast(world, path), catalogue);
}

const core::BodyInput* find_body(const core::Scene& scene, const std::string& name) {
  for (const core::ComponentInput& component : scene.components) {
    for (const core::BodyInput& body : component.bodies) {
      if (body.name == name) return &body;
    }
  }
  return nullptr;
}

core::BodyPlace place_of(const core::Scene& scene, const std::string& name) {
  for (std::size_t c = 0; c < scene.components.size(); ++c) {
    for (std::size_t b = 0; b < scene.components[c].bodies.size(); ++b) {
      if (scene.components[c].bodies[b].name == name) return {c, b};
    }
  }
  return {};
}

/// A body's shape with its operands at their places in another scene; nullopt if an operand is missing there.
std::optional<core::Geometry> translated(const core::Geometry& geometry, const core::Scene& from,
                                         const core::Scene& to) {
  const auto* difference = std::get_if<core::BoolGeometry>(&geometry);
  if (difference == nullptr) return geometry;
  const core::BoolGeometry there{place_of(to, core::body_at(from, difference->minuend).name),
                                 place_of(to, core::body_at(from, difference->subtrahend).name)};
  const std::size_t none = core::BodyPlace{}.component;
  if (there.minuend.component == none || there.subtrahend.component == none) return {};
  return there;
}

/// The frame of the body's shape.
core::WorkPlane plane_of(const core::BodyInput& body, const core::Scene& scene) {
  return body.work_plane ? scene.work_planes.at(*body.work_plane) : core::WorkPlane{};
}

/// The axes of a restart file's input have been normalised twice, which may change the last digits.
bool same_frame(const core::WorkPlane& a, const core::WorkPlane& b) {
  constexpr double rounding = 1e-14;
  const auto close = [](const core::Vec3<double>& u, const core::Vec3<double>& v) {
    return dot(u - v, u - v) <= rounding * rounding;
  };
  return a.origin == b.origin && close(a.x_axis, b.x_axis) && close(a.y_axis, b.y_axis) &&
         close(a.z_axis, b.z_axis);
}

/// Empty where the input does not give them.
std::string words_of_units(const core::HeaderInput& header) {
  if (header.length_unit.empty() && header.mass_unit.empty() && header.time_unit.empty()) return {};
  return fmt::format("{} {} {}", header.length_unit, header.mass_unit, header.time_unit);
}

/// Rejects changes of the input with -rt that cannot take effect, since the particles already exist. Throws
/// InputErrors.
void refuse_what_is_over(const core::Scene& old, const core::Scene& now) {
  std::vector<core::Diagnostic> faults;
  core::Scene then = now;
  const std::string text = io::to_text(now);
  const auto compare = [&](const core::SourceLocation& at, const char* element, const std::string& name,
                           std::string_view what, bool differs = false) {
    if (!differs && io::to_text(then) == text) return;
    faults.push_back(
        {at.file, at.line, element, name.empty() ? "" : "name", name,
         fmt::format("differs from the input of the restart file{}: the particles exist already, so "
                     "the change would have no effect; restore it (-rt may change Grid, Solution, "
                     "Output, Deactive, loads and material parameters)",
                     what)});
  };
  if (const std::string before = words_of_units(old.header), stated = words_of_units(now.header);
      !before.empty() && !stated.empty() && before != stated)
    faults.push_back(
        {now.provenance.path,
         0,
         "Header",
         {},
         {},
         fmt::format("Unit is \"{}\", but \"{}\" in the input of the restart file, in whose units its "
                     "particles are: restore it, and give all numbers in those units",
                     stated, before)});
  for (core::ComponentInput& component : then.components) {
    for (core::BodyInput& body : component.bodies) {
      const core::BodyInput* before = find_body(old, body.name);
      if (before == nullptr || body.deactivated) continue;
      // New loads, outputs and material parameters take effect; these properties do not.
      const core::BodyInput stated = body;
      const auto check = [&](std::string_view what, bool differs = false) {
        compare(stated.source, "Body", stated.name, what, differs);
        body = stated;
      };
      body.type = before->type;
      const std::optional<core::Geometry> geometry = translated(before->geometry, old, now);
      if (geometry) body.geometry = *geometry;
      const bool moved = !same_frame(plane_of(*before, old), plane_of(stated, now));
      check(" in its geometry", !geometry || moved);
      body.density = before->density;
      check(" in its density (density, else ReferenceDensity of its material)");
      body.initial_velocity = before->initial_velocity;
      body.initial_velocity_expressions = before->initial_velocity_expressions;
      check(" in its InitialVelocity");
      body.initial_temperature = before->initial_temperature;
      check(" in its initial temperature");
    }
  }
  then.detonations = old.detonations;
  // A missing Detonation has no line; it would precede the Grid.
  compare(now.detonations.empty() ? now.grid.source : now.detonations.front().source, "Detonation", "", "");
  if (!faults.empty()) throw core::InputErrors(faults);
}

}  // namespace

std::string to_line(const core::Diagnostic& note) { return "note       " + to_text(note); }

void require_newton_solver(const core::Scene& scene) {
  if (scene.solution.integration != core::Integration::implicit) return;
  if (const std::string why = parallel::why_no_newton_solver(); !why.empty())
    throw core::InputErrors(scene.solution.source, "Solution Integration=\"impl\"",
                            "is not available: " + why);
}

Case load_case(const RunOptions& options, const parallel::Communicator& world,
               const core::Catalogue& catalogue) {
  if (!is_restart(options.job)) {
    if (options.restart_input) {
      throw core::InputErrors(core::SourceLocation{options.job, 0}, "-rt",
                              "requires a restart file: give Job_<step>.pe instead of an input file");
    }
    return from_input(options.job, world, catalogue);
  }
  const std::string restart = find_restart(options, world);
  Case c;
  if (options.restart_input) {
    c = from_input(*options.restart_input, world, catalogue);
    c.restart_job = parallel::on_root_then_all<io::FileError>(world, [&] {
      const io::RestartScene before = io::read_restart_scene(restart);
      refuse_what_is_over(io::parse_scene(before.text, before.path, catalogue, {.check_files = false}),
                          *c.scene);
      return before.job_name;
    });
  } else {
    std::string path;
    const std::string bytes = parallel::on_root_then_all<io::FileError>(world, [&] {
      io::RestartScene scene = io::read_restart_scene(restart);
      path = scene.path;
      io::parse_scene(scene.text, path, catalogue, {.check_files = false});
      return scene.text;
    });
    c = parsed(bytes, parallel::broadcast(world, path), catalogue);
    c.restart_job = c.scene->provenance.job_name;
  }
  c.restart = restart;
  return c;
}

ExitCode convert_restart(const RunOptions& options, const parallel::Communicator& world,
                         const core::Catalogue& catalogue) {
  if (!is_restart(options.job)) {
    throw core::InputErrors(core::SourceLocation{options.job, 0}, "-h5pt",
                            "converts a restart file: give a Job_<step>.pe");
  }
  const Case c = load_case(options, world, catalogue);
  const std::string& restart = *c.restart;
  std::vector<io::Variable> variables;
  if (c.scene->output.post_processing)
    variables = io::variables_of(c.scene->output.post_processing->variables);
  parallel::MpiCommunication communication(world);
  const std::string target =
      options.output_dir + "/" + std::filesystem::path(restart).stem().string() + ".h5part";
  io::together(communication, [&] {
    if (communication.reductions.rank() == 0) io::make_folder(options.output_dir);
  });
  io::restart_to_h5part(restart, target, variables, false, communication);
  if (world.rank() == 0) std::printf("%s\n", target.c_str());
  return done;
}

}  // namespace mpm::apps
