// mpm_point: loads one particle of a material, from an input file or the library, along a path of strains and
// stresses as in a laboratory test; prints the response as a table (CSV) and plots it (SVG). Exit code 0
// done, 2 wrong input, 3 undefined response of the material, 5 file error.

#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "apps/common/command_line.hpp"
#include "apps/common/faults.hpp"
#include "apps/common/options.hpp"
#include "apps/common/point_path.hpp"
#include "apps/common/point_table.hpp"
#include "apps/mpm.hpp"
#include "core/scene/errors.hpp"
#include "io/input/material_reader.hpp"
#include "physics/checks/law_checks.hpp"
#include "physics/material/material.hpp"

namespace mpm {

namespace {

struct Settings {
  std::string input, material, library, units, path, output, plot, data;
  std::vector<std::string> set;
  apps::PathDefaults defaults;
  bool isothermal = false;
  bool test = false;
  double strain = 0.02, duration = 0;
  double density = 0;
  double cell_size = 0;
  int every = 1;
};

io::MaterialChoice choose(Settings& settings, const Registry& registry) {
  if (settings.input.empty() == settings.library.empty())
    throw std::invalid_argument("give an input file or --library NAME; see --help");
  if (settings.isothermal) settings.set.emplace_back("PlasticWorkCoefficient=0");
  if (settings.library.empty())
    return io::read_material(settings.input, registry.catalogue(), {settings.material, settings.set});
  if (settings.units.empty())
    throw std::invalid_argument(
        "--units: library values are converted to your units, as in --units \"mm g ms\"");
  return io::library_material(settings.library, settings.units, registry.catalogue(), settings.set);
}

bool write(const std::string& file, const std::string& text) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "w"), &std::fclose);
  return stream && std::fwrite(text.data(), 1, text.size(), stream.get()) == text.size() &&
         std::fflush(stream.get()) == 0;
}

/// Reports on standard error what the table does not show; returns the exit code.
int report(const physics::PathEnd& end, const std::vector<physics::Leg>& legs,
           const physics::PointDriver& point, const std::string& stress_unit) {
  int code = 0;
  if (!end.reached) {
    fmt::print(stderr,
               "mpm_point: leg {} ({}): at time {} a stress of {:.6g} {} cannot be reached, the nearest is "
               "{:.6g}; the table ends there\n",
               end.leg + 1, legs[static_cast<std::size_t>(end.leg)].kind, point.time(), end.wanted,
               stress_unit, end.found);
    code = 3;
  }
  const core::MaterialEvents& events = point.events();
  if (events.not_finite > 0) {
    fmt::print(stderr, "mpm_point: the state is not finite in {} steps\n", events.not_finite);
    code = 3;
  }
  if (events.failed > 0)
    fmt::print(stderr, "mpm_point: the material failed along the path (column failed)\n");
  return code;
}

/// Converts a time or length from SI to the units of the input; unchanged if the input names no units.
double in_units_of(const io::MaterialChoice& choice, double si, const core::Dimension& dimension) {
  return choice.units ? si / choice.units->in_si(dimension) : si;
}

/// Runs the generic tests of a law on the material.
int test(Settings& settings, const Registry& registry) {
  const io::MaterialChoice choice = choose(settings, registry);
  physics::LawSample sample{choice.material, choice.detonations};
  sample.strain = settings.strain;
  sample.duration = settings.duration > 0 ? settings.duration : in_units_of(choice, 2e-5, {.time = 1});
  sample.cell_size = settings.cell_size > 0 ? settings.cell_size : in_units_of(choice, 1e-3, {.length = 1});
  int failed = 0;
  for (const physics::LawCheck& check : physics::law_checks()) {
    const std::vector<std::string> faults = check.failures(sample, registry);
    fmt::print("{:<7}{:<13}{}\n", faults.empty() ? "passed" : "FAILED", check.name, check.statement);
    for (const std::string& fault : faults) fmt::print("       {:<13}{}\n", "", fault);
    failed += faults.empty() ? 0 : 1;
  }
  if (std::fflush(stdout) != 0) return 5;
  if (failed > 0)
    fmt::print(stderr, "mpm_point: \"{}\" fails {} of {} tests\n", choice.material.name, failed,
               physics::law_checks().size());
  return failed > 0 ? 3 : 0;
}

int drive(Settings& settings, const Registry& registry) {
  const std::vector<physics::Leg> legs = apps::parse_path(settings.path, settings.defaults);
  const std::vector<apps::Measurement> measured =
      settings.data.empty() ? std::vector<apps::Measurement>{} : apps::read_measurements(settings.data);
  const io::MaterialChoice choice = choose(settings, registry);
  const auto material = physics::make_material(choice.material, choice.detonations, registry);
  physics::PointDriver point(*material, {.density = settings.density,
                                         .cell_size = settings.cell_size,
                                         .update = {.volume_update = choice.volume_update},
                                         .extra_columns = {core::Column::yield_stress}});
  const apps::PointTable table(point, choice.units);
  std::string text = table.heading();
  std::vector<apps::PointSample> samples;
  std::string last;
  const physics::PathEnd end = physics::walk(point, legs, [&](const physics::PathPoint& at) {
    const bool shown = samples.size() % static_cast<std::size_t>(settings.every) == 0;
    samples.push_back(apps::sample(point, at));
    if (shown) text += table.row(at);
    last = shown ? std::string() : table.row(at);
  });
  text += last;  // the end of the path is always printed

  if (settings.output.empty()) {
    fmt::print("{}", text);
    if (std::fflush(stdout) != 0) return 5;
  } else if (!write(settings.output, text)) {
    fmt::print(stderr, "mpm_point: cannot write {}\n", settings.output);
    return 5;
  }
  const std::string unit = table.unit("stress");
  const std::string title = fmt::format("{}: {}", choice.material.name, settings.path);
  if (!settings.plot.empty() && !write(settings.plot, apps::plot(title, samples, measured, unit))) {
    fmt::print(stderr, "mpm_point: cannot write {}\n", settings.plot);
    return 5;
  }
  if (!measured.empty()) {
    const apps::Misfit fit = apps::misfit(apps::stress_strain(samples), measured);
    fmt::print(stderr, "mpm_point: {} of {} measured points compared; rms difference {:.4g} {} ({:.3g} %)\n",
               fit.points, measured.size(), fit.rms, unit,
               fit.largest > 0 ? 100 * fit.rms / fit.largest : 0.0);
  }
  return report(end, legs, point, unit);
}

}  // namespace

int run_point(int argc, char** argv, const Registry& registry) {
  if (apps::say_faults(registry, true)) return 2;
  Settings settings;
  apps::CommandLine line(
      "Loads one particle of a material along a path of strains and stresses: the response of a law without "
      "a "
      "grid.\n\n"
      "  mpm_point --library OFHC-Cu-JC --units \"mm g ms\" --path \"uniaxial_stress 0.2 rate 1000\" --plot "
      "cu.svg\n"
      "  mpm_point case.xmp --material cu --path \"uniaxial_strain -0.1 rate 10\" -o cu.csv",
      "mpm_point");
  line.option("INPUT", settings.input,
              "input file with the material, with or without .xmp; other elements may be missing");
  line.option("-m,--material", settings.material,
              "name of the material; not needed if the file has only one");
  line.option("-l,--library", settings.library, "material of the library; mpm_check --materials lists all");
  line.option("-u,--units", settings.units, "units of path and table with --library, as in \"mm g ms\"");
  line.option("-s,--set", settings.set, "NAME=VALUE: overrides one parameter; may be repeated");
  line.flag("--isothermal", settings.isothermal,
            "plastic work does not heat: --set PlasticWorkCoefficient=0");
  line.option("-p,--path", settings.path, "the path, see below");
  line.flag("--test", settings.test,
            "instead of a path: runs the tests that hold for every law; exit code 3 if one fails");
  line.option("--strain", settings.strain, "with --test: strain that the paths reach beyond yield",
              apps::Range::positive, true);
  line.option("--duration", settings.duration,
              "with --test: duration of a path; 2e-5 s, or 2e-5 if the input does not name its units",
              apps::Range::positive);
  line.option("--repeat", settings.defaults.repeat, "number of times to run the whole path",
              apps::Range::positive);
  line.option("-r,--rate", settings.defaults.rate, "strain rate of legs without one", apps::Range::positive,
              true);
  line.option("-n,--steps", settings.defaults.steps, "steps of legs without a number", apps::Range::positive,
              true);
  line.option("--density", settings.density, "density at the start, if not the reference density",
              apps::Range::positive);
  line.option("--cell-size", settings.cell_size, "cell size, for the artificial viscosity; none without",
              apps::Range::positive);
  line.option("--every", settings.every, "print every N steps", apps::Range::positive);
  line.option("-o,--output", settings.output, "file for the table; default: standard output");
  line.option("--plot", settings.plot, "file for a plot (SVG): stress over strain, q over p, p over volume");
  line.option("--data", settings.data,
              "file of measured strain and stress, two columns: plotted, and the difference is printed");
  line.footer(apps::path_help());
  if (const std::optional<int> code = line.parse(argc, argv)) return *code;
  try {
    if (settings.test == !settings.path.empty())
      throw std::invalid_argument("give --path, or --test; see --help");
    return settings.test ? test(settings, registry) : drive(settings, registry);
  } catch (const core::InputErrors& errors) {
    fmt::print(stderr, "{}\n", errors.what());
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "mpm_point: out of memory\n");
    return apps::out_of_resources;
  } catch (const std::exception& error) { fmt::print(stderr, "mpm_point: {}\n", error.what()); }
  return 2;
}

}  // namespace mpm
