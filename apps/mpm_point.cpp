// mpm_point INPUT --material NAME --path KIND --to STRAIN...: drives one particle of a material of an input
// file along a strain path and prints the response as a table (CSV): for calibration, and to see what a law
// does. Exit code 0 done, 2 wrong input, 3 where the material gave no defined answer.

#include <array>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/scene/scene.hpp"
#include "io/input/reader.hpp"
#include "physics/catalogue.hpp"
#include "physics/material/material.hpp"
#include "physics/point/point_driver.hpp"

namespace {

using namespace mpm;
using core::Column;

struct Settings {
  std::string input;
  std::string material;
  std::string output;
  physics::Path path{.rate = 1, .targets = {}, .steps = 1000};
  std::vector<double> gradient;
  std::vector<double> cycle;
  double density = 0;
  double cell_size = 0;
  int every = 1;
};

const std::map<std::string, physics::PathKind> kinds{
    {"uniaxial-strain", physics::PathKind::uniaxial_strain},
    {"uniaxial-stress", physics::PathKind::uniaxial_stress},
    {"simple-shear", physics::PathKind::simple_shear},
    {"hydrostatic", physics::PathKind::hydrostatic},
    {"gradient", physics::PathKind::gradient},
};

/// Columns of the table beyond stress and energy, where the material carries them.
constexpr std::array optional_columns{Column::effective_plastic_strain,
                                      Column::yield_stress,
                                      Column::temperature,
                                      Column::damage,
                                      Column::failed,
                                      Column::burn_fraction,
                                      Column::porosity,
                                      Column::bulking_pressure};

const core::MaterialInput& find_material(const core::Scene& scene, const std::string& name) {
  std::string names;
  for (const core::MaterialInput& material : scene.materials) {
    if (material.name == name || (name.empty() && scene.materials.size() == 1)) return material;
    names += " " + material.name;
  }
  throw CLI::ValidationError("--material", "which one of:" + names);
}

void complete_path(Settings& settings) {
  if (settings.path.kind == physics::PathKind::gradient) {
    const std::vector<double>& g = settings.gradient;
    if (g.size() != 9) throw CLI::ValidationError("--gradient", "nine components, row by row, are needed");
    settings.path.gradient = {g[0], g[1], g[2], g[3], g[4], g[5], g[6], g[7], g[8]};
  }
  if (!settings.cycle.empty()) {
    const double amplitude = settings.cycle[0];
    const int cycles = settings.cycle.size() > 1 ? static_cast<int>(settings.cycle[1]) : 1;
    for (int i = 0; i < cycles; ++i)
      settings.path.targets.insert(settings.path.targets.end(), {amplitude, -amplitude});
    settings.path.targets.push_back(0);
  }
  if (settings.path.targets.empty()) throw CLI::ValidationError("--to", "--to or --cycle is needed");
}

void print_header(std::FILE* file, const physics::PointDriver& point) {
  fmt::print(
      file,
      "time,strain,stress_xx,stress_yy,stress_zz,stress_xy,stress_yz,stress_xz,pressure,viscous_pressure,"
      "von_mises,density,internal_energy,sound_speed");
  for (Column column : optional_columns) {
    if (point.has(column)) fmt::print(file, ",{}", core::name_of(column));
  }
  fmt::print(file, "\n");
}

void print_row(std::FILE* file, const physics::PointDriver& point, double strain) {
  const core::Sym3<double> s = point.stress();
  fmt::print(file, "{},{},{},{},{},{},{},{},{},{},{},{},{},{}", point.time(), strain, s.xx, s.yy, s.zz, s.xy,
             s.yz, s.xz, point.value(Column::pressure), point.value(Column::viscous_pressure),
             mises(point.deviator()), point.density(), point.energy(), point.sound_speed());
  for (Column column : optional_columns) {
    if (point.has(column)) fmt::print(file, ",{}", point.value(column));
  }
  fmt::print(file, "\n");
}

int run(const Settings& settings) {
  const core::Scene scene = io::read_scene(settings.input, physics::catalogue());
  const auto material = physics::make_material(find_material(scene, settings.material), scene.detonations);
  physics::PointDriver point(*material,
                             {.density = settings.density,
                              .cell_size = settings.cell_size,
                              .update = {.volume_update = static_cast<int>(scene.solution.volume.update)},
                              .extra_columns = {Column::yield_stress}});

  const bool to_file = !settings.output.empty();
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> opened(
      to_file ? std::fopen(settings.output.c_str(), "w") : nullptr, &std::fclose);
  if (to_file && !opened) {
    fmt::print(stderr, "mpm_point: cannot write {}\n", settings.output);
    return 5;
  }
  std::FILE* table = to_file ? opened.get() : stdout;

  print_header(table, point);
  int row = 0;
  const int rows = settings.path.steps * static_cast<int>(settings.path.targets.size());
  const bool converged = physics::drive(point, settings.path, [&](double strain) {
    if (row % settings.every == 0 || row == rows) print_row(table, point, strain);
    ++row;
  });
  if (!converged)
    fmt::print(stderr, "mpm_point: the lateral stress could not be brought to zero in every step\n");
  const core::MaterialEvents& events = point.events();
  if (events.not_finite > 0)
    fmt::print(stderr, "mpm_point: the state is no number in {} steps\n", events.not_finite);
  if (std::fflush(table) != 0) {
    fmt::print(stderr, "mpm_point: writing the table failed\n");
    return 5;
  }
  return converged && events.not_finite == 0 ? 0 : 3;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("Drives one particle of a material along a strain path. Strains are logarithmic, rates true.");
  app.add_option("INPUT", settings.input, "input file with the material, with or without .xmp")->required();
  app.add_option("-m,--material", settings.material, "its name; not needed where the file has only one");
  app.add_option("-p,--path", settings.path.kind, "kind of path")
      ->transform(CLI::CheckedTransformer(kinds))
      ->default_str("uniaxial-strain");
  app.add_option("-t,--to", settings.path.targets, "strain to reach; several: one after the other");
  app.add_option("--cycle", settings.cycle, "AMPLITUDE [CYCLES]: to and fro, and back to zero")
      ->expected(1, 2);
  app.add_option("-r,--rate", settings.path.rate, "strain rate")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("-n,--steps", settings.path.steps, "steps to each strain")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--gradient", settings.gradient,
                 "velocity gradient per unit rate, row by row, for --path gradient")
      ->expected(9);
  app.add_option("--density", settings.density, "density at the start, if not the reference density")
      ->check(CLI::PositiveNumber);
  app.add_option("--cell-size", settings.cell_size, "cell size, for the artificial viscosity; none without")
      ->check(CLI::PositiveNumber);
  app.add_option("--every", settings.every, "print every so many steps")->check(CLI::PositiveNumber);
  app.add_option("-o,--output", settings.output, "file for the table; standard output without");
  try {
    app.parse(argc, argv);
    complete_path(settings);
    return run(settings);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const core::InputErrors& errors) {
    fmt::print(stderr, "{}\n", errors.what());
    return 2;
  }
}
