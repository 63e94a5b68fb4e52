// mpm_check FILE...: checks input files, and the particle files that they name, without running them.
// Prints every complaint; exit code 0 when all files are right, 2 when any is not, 6 out of memory.

#include <cstdio>
#include <new>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/common/options.hpp"
#include "core/discretise/seeds.hpp"
#include "core/scene/scene.hpp"
#include "io/input/echo.hpp"
#include "io/input/library.hpp"
#include "io/input/reader.hpp"
#include "io/input/reference.hpp"
#include "physics/catalogue.hpp"
#include "physics/material/material.hpp"

namespace {

using namespace mpm;

struct Settings {
  std::vector<std::string> files;
  bool reference = false;
  bool echo = false;
  bool accept_later = false;
  bool materials = false;
};

/// Makes every material and the sources of all particles, whose files it reads to their ends: the number of
/// particles, an estimate. Throws every complaint about what the laws, shapes and files forbid together.
double make_everything(const core::Scene& scene) {
  double count = 0;
  core::Complaints wrong;
  wrong.collect([&] { physics::make_materials(scene); });
  core::for_each_active_body(scene, [&](int, const core::BodyInput& body) {
    wrong.collect([&] { count += core::make_seed_source(scene, body)->expected_particles(); });
  });
  wrong.raise_if_any();
  return count;
}

std::string summary(const core::Scene& scene) {
  std::size_t bodies = 0;
  for (const core::ComponentInput& component : scene.components) bodies += component.bodies.size();
  const auto& axes = scene.grid.axes;
  return fmt::format("ok: materials {}, components {}, bodies {}, grid {} x {} x {} cells, end time {}",
                     scene.materials.size(), scene.components.size(), bodies, axes[0].cells, axes[1].cells,
                     axes[2].cells, scene.solution.end_time);
}

bool check(const std::string& job, const Settings& settings) {
  try {
    const core::Scene scene = io::read_scene(job, physics::catalogue(),
                                             {.check_files = true, .accept_later = settings.accept_later});
    std::string verdict = summary(scene);
    if (!settings.accept_later) verdict += fmt::format(", about {:.4g} particles", make_everything(scene));
    if (settings.echo)
      fmt::print("{}", io::to_text(scene));
    else
      fmt::print("{}: {}\n", scene.provenance.path, verdict);
    return true;
  } catch (const core::InputErrors& errors) {
    fmt::print(stderr, "{}\n", errors.what());
    return false;
  }
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("Checks input files of mpm_run.");
  app.add_option("FILE", settings.files, "input files, with or without .xmp");
  app.add_flag("--reference", settings.reference, "print the keyword reference in Markdown");
  app.add_flag("--echo", settings.echo, "print each file as it was understood, with all defaults");
  app.add_flag("--materials", settings.materials, "list the material library: laws, values, sources");
  app.add_flag("--accept-later", settings.accept_later, "let pass what is known but not implemented yet");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) { return app.exit(error) == 0 ? 0 : 2; }
  if (settings.reference) fmt::print("{}", io::keyword_reference(physics::catalogue()));
  if (settings.materials) fmt::print("{}", io::library_listing(io::library(), physics::catalogue()));
  if (settings.files.empty() && !settings.reference && !settings.materials) {
    fmt::print(stderr, "mpm_check: no file given; see --help\n");
    return 2;
  }
  try {
    bool all_right = true;
    for (const std::string& file : settings.files) all_right = check(file, settings) && all_right;
    return all_right ? 0 : 2;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "mpm_check: out of memory\n");
    return apps::out_of_resources;
  }
}
