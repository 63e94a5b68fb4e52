// mpm_check FILE...: checks input files and the particle files that they name without running them. Reports
// every input error that a run would find before its first step, and settings without effect. Exit code 0 if
// all files are correct, 2 if any is not, 6 out of memory.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "apps/common/case.hpp"
#include "apps/common/command_line.hpp"
#include "apps/common/faults.hpp"
#include "apps/common/options.hpp"
#include "apps/mpm.hpp"
#include "core/scene/scene.hpp"
#include "core/setup/check_setup.hpp"
#include "core/simd/denormals.hpp"
#include "io/input/echo.hpp"
#include "io/input/library.hpp"
#include "io/input/reader.hpp"
#include "io/input/reference.hpp"
#include "io/input/user_specification.hpp"
#include "io/output/variables.hpp"
#include "physics/material/material.hpp"

namespace mpm {

namespace {

struct Settings {
  std::vector<std::string> files;
  std::string specification;
  bool reference = false;
  bool echo = false;
  bool accept_later = false;
  bool materials = false;
};

std::string summary(const core::Scene& scene) {
  std::size_t bodies = 0;
  for (const core::ComponentInput& component : scene.components) bodies += component.bodies.size();
  const auto& axes = scene.grid.axes;
  return fmt::format("ok: materials {}, components {}, bodies {}, grid {} x {} x {} cells, end time {}",
                     scene.materials.size(), scene.components.size(), bodies, axes[0].cells, axes[1].cells,
                     axes[2].cells, scene.solution.end_time);
}

/// Checks beyond the input language: materials and everything that a run sets up. Throws all faults.
double make_everything(const core::Scene& scene, const Registry& registry) {
  return core::check_setup(std::make_shared<const core::Scene>(scene),
                           physics::make_materials(scene, registry), io::columns_for(scene.output));
}

class Checker {
 public:
  Checker(const Settings& settings, const Registry& registry)
      : settings_(settings), registry_(registry), language_(io::language(registry.catalogue())) {
    if (settings.specification.empty()) return;
    users_ = io::read_user_specification(settings.specification, registry.catalogue());
    language_ = io::with_additions(std::move(language_), users_->root);
  }

  bool check(const std::string& job) const {
    try {
      std::vector<core::Diagnostic> notes, foreign;
      const std::filesystem::path file = io::find_input(job);
      const io::ReadOptions options{.check_files = true,
                                    .accept_later = settings_.accept_later,
                                    .notes = &notes,
                                    .users = users_ ? &*users_ : nullptr,
                                    .foreign = users_ ? &foreign : nullptr};
      const core::Scene scene = io::parse_scene(io::read_bytes(file), file, language_, options);
      std::string verdict = summary(scene);
      if (!settings_.accept_later && foreign.empty())
        verdict += fmt::format(", about {:.4g} particles", make_everything(scene, registry_));
      apps::require_newton_solver(scene);
      if (users_) verdict += ", by " + users_->file;
      if (settings_.echo)
        fmt::print("{}", io::to_text(scene));
      else
        fmt::print("{}: {}\n", scene.provenance.path, verdict);
      notes.insert(notes.begin(), foreign.begin(), foreign.end());
      for (const core::Diagnostic& note : notes)
        fmt::print(settings_.echo ? stderr : stdout, "{}\n", apps::to_line(note));
      return true;
    } catch (const core::InputErrors& errors) {
      fmt::print(stderr, "{}\n", errors.what());
      return false;
    }
  }

 private:
  const Settings& settings_;
  const Registry& registry_;
  std::optional<io::UserSpecification> users_;
  io::ElementSpec language_;
};

/// The Specification.xml beside the program, if there is one.
std::string specification_beside(const char* program) {
  std::error_code ignored;
  std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", ignored);
  if (self.empty()) self = program;
  const std::filesystem::path file = self.parent_path() / "Specification.xml";
  return std::filesystem::exists(file, ignored) ? file.string() : std::string();
}

}  // namespace

int run_check(int argc, char** argv, const Registry& registry) {
  if (apps::say_faults(registry, true)) return 2;
  Settings settings;
  apps::CommandLine line("Checks input files of mpm_run.", "mpm_check");
  line.option("FILE", settings.files, "input files, with or without .xmp");
  line.option("--specification", settings.specification,
              "also check the files against this Specification.xml (manual, 5.1); default: the one beside "
              "the program, if any");
  line.flag("--reference", settings.reference, "print the keyword reference in Markdown");
  line.flag("--echo", settings.echo, "print each file as interpreted, with all defaults");
  line.flag("--materials", settings.materials, "list the material library: laws, values, sources");
  line.flag("--accept-later", settings.accept_later, "accept input that is known but not implemented yet");
  if (const std::optional<int> code = line.parse(argc, argv)) return *code;
  if (settings.specification.empty()) settings.specification = specification_beside(argv[0]);
  if (settings.reference) fmt::print("{}", io::keyword_reference(registry.catalogue()));
  if (settings.materials) fmt::print("{}", io::library_listing(io::library(), registry.catalogue()));
  if (settings.files.empty() && !settings.reference && !settings.materials) {
    fmt::print(stderr, "mpm_check: no file given; see --help\n");
    return 2;
  }
  core::flush_denormals_to_zero();  // as mpm_run does
  try {
    const Checker checker(settings, registry);
    bool all_right = true;
    for (const std::string& file : settings.files) all_right = checker.check(file) && all_right;
    return all_right ? 0 : 2;
  } catch (const core::InputErrors& errors) {  // of the Specification
    fmt::print(stderr, "{}\n", errors.what());
    return 2;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "mpm_check: out of memory\n");
    return apps::out_of_resources;
  }
}

}  // namespace mpm
