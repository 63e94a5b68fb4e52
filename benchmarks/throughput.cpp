// Speed of the explicit step relative to the limits of the machine: particle-steps per second and core,
// bytes of state and of traffic per particle-step, shares of the memory and arithmetic ceilings, the ratio to
// the naive reference stepper, seconds per phase and peak memory, for each scheme and size, all measured in
// one run. The same bar with each shape function, and in a larger box of empty space, follow.
#include <cstdio>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <omp.h>
#include <sys/resource.h>

#include "benchmarks/common/bar.hpp"
#include "benchmarks/common/ceilings.hpp"
#include "benchmarks/common/child.hpp"
#include "benchmarks/common/clock.hpp"
#include "benchmarks/common/cost.hpp"
#include "benchmarks/common/machine.hpp"
#include "benchmarks/common/table_file.hpp"
#include "core/shape/list.hpp"
#include "core/simd/denormals.hpp"
#include "tests/support/reference_stepper.hpp"

namespace mpm::benchmarks {
namespace {

std::vector<std::string> shape_names() {
  std::vector<std::string> list;
  [&]<class... S>(std::type_identity<std::tuple<S...>>) {
    (list.emplace_back(S::name), ...);
  }(std::type_identity<core::Shapes>());
  return list;
}

struct Options {
  std::vector<double> sizes{20e3, 200e3, 1.3e6, 10e6};
  std::vector<std::string> schemes{"MUSL", "USF", "USL"};
  int threads = 1;
  int warm_up = 20;
  int repeats = 5;
  double seconds = 3;            ///< minimum time of all repeats
  double reference_limit = 2e6;  ///< particles; the reference is slow
  double shapes = 200e3;         ///< particles of the comparison of shape functions; 0: none
  std::vector<std::string> names = shape_names();  ///< of that comparison
  int rounds = 5;                                  ///< of that comparison
  double empty_space = 200e3;                      ///< particles of that comparison; 0: none
  std::string csv, phases_csv, shapes_csv;
};

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

Json to_json(const Ceilings& c) { return {{"triad", c.triad}, {"in_place", c.in_place}, {"flops", c.flops}}; }
Ceilings ceilings_of(const Json& j) { return {j["triad"], j["in_place"], j["flops"]}; }

Ceilings measure_ceilings_apart(int threads) {
  return ceilings_of(in_child([&] {
    omp_set_num_threads(threads);
    return to_json(measure_ceilings());
  }));
}

/// Steps of a run with the time of each phase. A repeat is a whole number of sorting intervals, so that each
/// includes the periodic work.
struct Stopwatch {
  explicit Stopwatch(const core::Stepper& s) : stepper(s), phases(s.phases().size()) {}
  Seconds run(int steps) {
    std::fill(phases.begin(), phases.end(), Seconds{});
    const Seconds start = Seconds::now();
    Seconds before = start;
    for (int i = 0; i < steps; ++i) {
      for (std::size_t p = 0; p < phases.size(); ++p) {
        stepper.phases()[p].run();
        const Seconds now = Seconds::now();
        phases[p] += now - before;
        before = now;
      }
    }
    return before - start;
  }
  const core::Stepper& stepper;
  std::vector<Seconds> phases;  ///< of the last run
};

/// All measurements of one case, in this process.
Json measure(const BarInput& input, const Options& o) {
  omp_set_num_threads(o.threads);
  const double at_start = peak_memory();
  BarRun bar(endless(input.scene()));
  Stopwatch watch(*bar.stepper);
  watch.run(o.warm_up);
  const double n = bar.particles();
  constexpr int steps = core::Stepper::sorting_interval;
  Series cores, wall;
  std::vector<double> best_phases;
  double spent = 0;
  while (static_cast<int>(cores.size()) < o.repeats || (spent < o.seconds && cores.size() < 200)) {
    const Seconds passed = watch.run(steps);
    const double scale = 1e9 / (n * steps);
    cores.add(scale * passed.of_cores(o.threads));
    wall.add(scale * passed.wall);
    spent += passed.wall;
    if (cores.index_of_best() + 1 != cores.size()) continue;
    best_phases.clear();
    for (const Seconds& p : watch.phases) best_phases.push_back(scale * p.of_cores(o.threads));
  }
  const core::ColumnLayout& layout = bar.model.bodies[0].pool->layout();
  Json phases = Json::array();
  const auto costs = phase_costs(bar.scene->solution.scheme, Filling(bar.model),
                                 layout.columns() - core::ColumnSet::mechanics().size());
  double bytes = 0, node_bytes = 0, operations = 0;
  for (std::size_t p = 0; p < best_phases.size(); ++p) {
    const std::string& name = bar.stepper->phases()[p].name;
    PhaseCost cost{name};
    for (const PhaseCost& c : costs) {
      if (c.phase == name) cost = c;
    }
    bytes += cost.bytes();
    node_bytes += cost.node_read + cost.node_written;
    operations += cost.operations;
    phases.push_back(
        {{"phase", name}, {"ns", best_phases[p]}, {"bytes", cost.bytes()}, {"operations", cost.operations}});
  }
  return {{"particles", n},
          {"bricks", bar.model.grid->owned()},
          {"repeats", cores.size()},
          {"steps", steps},
          {"best_ns", cores.best()},
          {"median_ns", cores.median()},
          {"best_wall_ns", wall.best()},
          {"median_wall_ns", wall.median()},
          {"state_bytes", layout.bytes_per_particle()},
          {"moved_bytes", bytes},
          {"moved_node_bytes", node_bytes},
          {"operations", operations},
          {"state_and_bricks", bar.state_bytes() + bar.brick_bytes()},
          {"peak_memory", peak_memory()},
          {"memory_at_start", at_start},
          {"phases", phases}};
}

/// The oracle on the same particles, single-threaded: ns per particle-step.
Json measure_reference(const BarInput& input) {
  core::flush_denormals_to_zero();
  tests::ReferenceCase setup = tests::taylor_bar(bar_spacing(input.particles));
  setup.scheme = input.scheme == "USF"     ? tests::ReferenceScheme::usf
                 : input.scheme == "USL"   ? tests::ReferenceScheme::usl
                 : input.scheme == "USAVG" ? tests::ReferenceScheme::usavg
                                           : tests::ReferenceScheme::musl;
  setup.dt_factor = 0.4;
  tests::ReferenceStepper stepper(std::move(setup));
  stepper.step();  // the first one touches the memory
  const auto n = static_cast<double>(stepper.particles().size());
  Series ns;
  double spent = 0;
  while (ns.size() < 3 || (spent < 2 && ns.size() < 20)) {
    const Seconds before = Seconds::now();
    stepper.step();
    const Seconds passed = Seconds::now() - before;
    ns.add(1e9 * passed.cpu / n);
    spent += passed.wall;
  }
  return {{"particles", n}, {"best_ns", ns.best()}, {"median_ns", ns.median()}};
}

/// A row of the results with derived values.
struct Row {
  std::string scheme;
  Json r;                         ///< of measure()
  std::optional<Json> reference;  ///< of measure_reference()

  double get(const char* key) const { return r[key]; }
  double million_per_core() const { return 1e3 / get("best_ns"); }
  double floor_ns(const Ceilings& c, int threads) const {
    return 1e9 * get("moved_bytes") * threads / c.bandwidth();
  }
};

void print_tables(const std::vector<Row>& rows, const Ceilings& c, int threads) {
  fmt::print(
      "\nceilings, {} thread(s): triad {:.1f} GB/s, in-place read and write {:.1f} GB/s, FMA {:.1f} "
      "GFLOP/s\n",
      threads, 1e-9 * c.triad, 1e-9 * c.in_place, 1e-9 * c.flops);
  fmt::print("\nns are a core's time per particle-step; floor: the bytes moved at the larger bandwidth.\n");
  fmt::print("{:<5} {:>9} {:>8} {:>8} {:>8} {:>7} {:>7} {:>6} {:>6} {:>6} {:>7} {:>7} {:>8} {:>7}\n", "",
             "particles", "best ns", "median", "M/s/core", "state B", "moved B", "FLOP", "DRAM", "FLOP",
             "floor", "x floor", "naive ns", "x naive");
  for (const Row& row : rows) {
    const double ns = row.get("best_ns"), floor = row.floor_ns(c, threads);
    const double naive = row.reference ? (*row.reference)["best_ns"].get<double>() : 0;
    fmt::print(
        "{:<5} {:>9.0f} {:>8.2f} {:>8.2f} {:>8.1f} {:>7.0f} {:>7.0f} {:>6.0f} {:>5.0f}% {:>5.0f}% {:>7.2f} "
        "{:>7.2f} {:>8} {:>7}\n",
        row.scheme, row.get("particles"), ns, row.get("median_ns"), row.million_per_core(),
        row.get("state_bytes"), row.get("moved_bytes"), row.get("operations"), 100 * floor / ns,
        100 * row.get("operations") * threads / (1e-9 * c.flops * ns), floor, ns / floor,
        naive > 0 ? fmt::format("{:.1f}", naive) : "-", naive > 0 ? fmt::format("{:.1f}", naive / ns) : "-");
  }
  fmt::print("\nmemory: peak resident against state and occupied bricks\n");
  for (const Row& row : rows) {
    fmt::print(
        "{:<5} {:>9.0f} {:>10.1f} MB peak {:>10.1f} MB state and bricks, ratio {:.2f} ({:.1f} MB before the "
        "case)\n",
        row.scheme, row.get("particles"), 1e-6 * row.get("peak_memory"), 1e-6 * row.get("state_and_bricks"),
        row.get("peak_memory") / row.get("state_and_bricks"), 1e-6 * row.get("memory_at_start"));
  }
  fmt::print("\nphases of the best repeat\n");
  for (const Row& row : rows) {
    fmt::print("{:<5} {:>9.0f} {:<30} {:>8} {:>6} {:>8} {:>7} {:>7}\n", row.scheme, row.get("particles"), "",
               "ns", "share", "bytes", "GB/s", "GFLOP/s");
    for (const Json& p : row.r["phases"]) {
      const double ns = p["ns"], bytes = p["bytes"], operations = p["operations"];
      fmt::print("{:<15} {:<30} {:>8.3f} {:>5.1f}% {:>8.0f} {:>7.1f} {:>7.1f}\n", "",
                 p["phase"].get<std::string>(), ns, 100 * ns / row.get("best_ns"), bytes, bytes / ns,
                 operations / ns);
    }
  }
}

void write_csv(const std::string& path, const Facts& facts, const std::vector<Row>& rows, const Ceilings& c,
               int threads) {
  const TableFile file(path, facts);
  fmt::print(
      file.handle,
      "scheme,particles,threads,repeats,steps_per_repeat,best_ns,median_ns,best_wall_ns,median_wall_ns,"
      "million_particle_steps_per_s_core,state_bytes,moved_bytes,moved_node_bytes,operations,"
      "triad_bytes_per_s,in_place_bytes_per_s,fma_flops,share_dram,share_flop,floor_ns,ratio_to_floor,"
      "reference_best_ns,reference_median_ns,ratio_to_reference,peak_memory,state_and_bricks,peak_over_"
      "state\n");
  for (const Row& row : rows) {
    const double ns = row.get("best_ns"), floor = row.floor_ns(c, threads);
    const double best = row.reference ? (*row.reference)["best_ns"].get<double>() : std::nan("");
    const double median = row.reference ? (*row.reference)["median_ns"].get<double>() : std::nan("");
    fmt::print(file.handle,
               "{},{:.0f},{},{:.0f},{:.0f},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.0f},{:.1f},{:.1f},{:.0f},",
               row.scheme, row.get("particles"), threads, row.get("repeats"), row.get("steps"), ns,
               row.get("median_ns"), row.get("best_wall_ns"), row.get("median_wall_ns"),
               row.million_per_core(), row.get("state_bytes"), row.get("moved_bytes"),
               row.get("moved_node_bytes"), row.get("operations"));
    fmt::print(file.handle,
               "{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.0f},{:.0f},{:.4g}\n",
               c.triad, c.in_place, c.flops, floor / ns,
               row.get("operations") * threads / (1e-9 * c.flops * ns), floor, ns / floor, best, median,
               best / ns, row.get("peak_memory"), row.get("state_and_bricks"),
               row.get("peak_memory") / row.get("state_and_bricks"));
  }
}

void write_phases_csv(const std::string& path, const Facts& facts, const std::vector<Row>& rows,
                      int threads) {
  const TableFile file(path, facts);
  fmt::print(file.handle, "scheme,particles,threads,phase,ns,moved_bytes,operations\n");
  for (const Row& row : rows) {
    for (const Json& p : row.r["phases"]) {
      fmt::print(file.handle, "{},{:.0f},{},\"{}\",{:.4g},{:.1f},{:.0f}\n", row.scheme, row.get("particles"),
                 threads, p["phase"].get<std::string>(), p["ns"].get<double>(), p["bytes"].get<double>(),
                 p["operations"].get<double>());
    }
  }
}

/// The phases of each family's best repeat, side by side.
void print_phases(const std::string& scheme, const std::vector<std::string>& names,
                  const std::vector<Json>& best) {
  fmt::print("{:<5} {:<28}", scheme, "ns by phase");
  for (const std::string& name : names) fmt::print(" {:>8.8}", name);
  fmt::print("\n");
  for (const Json& row : best.front()["phases"]) {
    fmt::print("{:<5} {:<28}", "", row["phase"].get<std::string>());
    for (const Json& r : best) {
      double ns = 0;
      for (const Json& p : r["phases"])
        if (p["phase"] == row["phase"]) ns = p["ns"];
      fmt::print(" {:>8.2f}", ns);
    }
    fmt::print("\n");
  }
}

/// The families of shape functions in turns, so that a drift of the machine affects all; each scheme alone.
void compare_shapes(const Options& o, const Facts& facts) {
  std::vector<std::string> names = o.names;
  std::erase(names, "linear");
  names.insert(names.begin(), "linear");  // the others are compared with it
  std::optional<TableFile> file;
  if (!o.shapes_csv.empty()) {
    file.emplace(o.shapes_csv, facts);
    fmt::print(file->handle, "scheme,shape,particles,rounds,best_ns,median_ns,ratio_to_linear,state_bytes\n");
  }
  fmt::print("\nshape functions: ns per particle-step of a core, in {} turns\n", o.rounds);
  fmt::print("{:<5} {:<18} {:>9} {:>8} {:>8} {:>9} {:>8}\n", "", "", "particles", "best ns", "median",
             "x linear", "state B");
  for (const std::string& scheme : o.schemes) {
    std::vector<Series> ns(names.size()), ratio(names.size());
    std::vector<Json> fastest(names.size());
    double linear = 0;
    for (int round = 0; round < o.rounds; ++round) {
      for (std::size_t i = 0; i < names.size(); ++i) {
        const BarInput input{.particles = o.shapes,
                             .scheme = scheme,
                             .grid_attributes = fmt::format(R"(shape="{}")", names[i])};
        const Json r = in_child([&] { return measure(input, o); });
        const double best = r["best_ns"];
        if (i == 0) linear = best;
        ns[i].add(best);
        ratio[i].add(best / linear);
        if (ns[i].index_of_best() + 1 == ns[i].size()) fastest[i] = r;
      }
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      const double particles = fastest[i]["particles"], bytes = fastest[i]["state_bytes"];
      fmt::print("{:<5} {:<18} {:>9.0f} {:>8.2f} {:>8.2f} {:>9.2f} {:>8.0f}\n", scheme, names[i], particles,
                 ns[i].best(), ns[i].median(), ratio[i].median(), bytes);
      if (file)
        fmt::print(file->handle, "{},{},{:.0f},{},{:.4g},{:.4g},{:.4g},{:.0f}\n", scheme, names[i], particles,
                   o.rounds, ns[i].best(), ns[i].median(), ratio[i].median(), bytes);
    }
    print_phases(scheme, names, fastest);
  }
}

/// The same bar in a box ten times larger along each axis: should cost nothing.
void compare_empty_space(const Options& o) {
  Series ns[2], memory[2];
  constexpr double boxes[2] = {1, 10};
  for (int pair = 0; pair < 3; ++pair) {  // alternating, so that a drift of the machine affects both
    for (int b = 0; b < 2; ++b) {
      const Json r = in_child([&] { return measure({.particles = o.empty_space, .box = boxes[b]}, o); });
      ns[b].add(r["best_ns"]);
      memory[b].add(r["peak_memory"]);
    }
  }
  fmt::print(
      "\nempty space: the bar of {:.0f} particles in its box, and in one ten times larger along each axis\n",
      o.empty_space);
  fmt::print("time   {:.2f} and {:.2f} ns per particle-step, {:+.1f} %\n", ns[0].best(), ns[1].best(),
             100 * (ns[1].best() / ns[0].best() - 1));
  fmt::print("memory {:.1f} and {:.1f} MB peak, {:+.1f} %\n", 1e-6 * memory[0].best(),
             1e-6 * memory[1].best(), 100 * (memory[1].best() / memory[0].best() - 1));
}

Options parse(int argc, char** argv) {
  Options o;
  CLI::App app("Particle-steps per second of the copper Taylor bar, against what the machine allows.",
               "throughput");
  app.add_option("--sizes", o.sizes, "particles")->delimiter(',')->capture_default_str();
  app.add_option("--schemes", o.schemes, "MUSL, USF, USL, USAVG")->delimiter(',')->capture_default_str();
  app.add_option("--threads", o.threads)->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--warm-up", o.warm_up, "steps before the first that counts")->capture_default_str();
  app.add_option("--repeats", o.repeats, "at least so many, of 20 steps")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--seconds", o.seconds, "of measured time per case, at least")->capture_default_str();
  app.add_option("--reference-limit", o.reference_limit, "no naive stepper above so many particles; 0: none")
      ->capture_default_str();
  app.add_option("--empty-space", o.empty_space, "particles of the comparison of boxes; 0: none")
      ->capture_default_str();
  app.add_option("--shapes", o.shapes, "particles of the comparison of shape functions; 0: none")
      ->capture_default_str();
  app.add_option("--shape-names", o.names, "of that comparison, beside linear")
      ->delimiter(',')
      ->check(CLI::IsMember(o.names));
  app.add_option("--rounds", o.rounds, "of that comparison")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--shapes-csv", o.shapes_csv, "file for that comparison");
  app.add_option("--csv", o.csv, "file for the results");
  app.add_option("--phases-csv", o.phases_csv, "file for the table of phases");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) { std::exit(app.exit(e)); }
  return o;
}

int run(int argc, char** argv) {
  const Options o = parse(argc, argv);
  const Facts facts = machine_facts();
  fmt::print("{}", facts_as_text(facts, ""));
  Ceilings ceilings = measure_ceilings_apart(o.threads);
  std::vector<Row> rows;
  for (const double size : o.sizes) {
    for (const std::string& scheme : o.schemes) {
      const BarInput input{.particles = size, .scheme = scheme};
      try {
        Row row{scheme, in_child([&] { return measure(input, o); }), {}};
        if (size <= o.reference_limit) row.reference = in_child([&] { return measure_reference(input); });
        fmt::print("{} with {:.0f} particles: {:.2f} ns\n", scheme, row.get("particles"), row.get("best_ns"));
        rows.push_back(std::move(row));
      } catch (const std::exception& e) {
        fmt::print("{} with {:.0f} particles left out: {}\n", scheme, size, e.what());
      }
      std::fflush(stdout);
    }
    // The machine may be faster later.
    ceilings.take_best(measure_ceilings_apart(o.threads));
  }
  print_tables(rows, ceilings, o.threads);
  if (!o.csv.empty()) write_csv(o.csv, facts, rows, ceilings, o.threads);
  if (!o.phases_csv.empty()) write_phases_csv(o.phases_csv, facts, rows, o.threads);
  if (o.shapes > 0) compare_shapes(o, facts);
  if (o.empty_space > 0) compare_empty_space(o);
  return rows.empty() && o.shapes <= 0 ? 1 : 0;
}

}  // namespace
}  // namespace mpm::benchmarks

int main(int argc, char** argv) {
  try {
    return mpm::benchmarks::run(argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
