// One case of a scaling study, under mpirun: the copper Taylor bar on the ranks given, as one line of JSON on
// rank 0: time per step, the parts of communication in it, and how evenly the ranks compute. scaling.py
// beside this file runs the list of cases and makes the tables.
// The computing time of a rank is the time of its steps minus that of its communication calls. If ranks x
// threads exceed the cores, wall time measures the scheduler; then the CPU time of the busiest rank per
// thread is taken, as with enough cores and free communication.
#include <algorithm>
#include <array>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <omp.h>
#include <unistd.h>

#include "benchmarks/common/bar.hpp"
#include "benchmarks/common/clock.hpp"
#include "benchmarks/common/machine.hpp"
#include "benchmarks/common/timed_communication.hpp"
#include "io/output/particle_order.hpp"
#include "parallel/communication.hpp"
#include "parallel/mpi.hpp"

namespace mpm::benchmarks {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  double particles = 200e3;
  std::string scheme = "MUSL", partition = "metis";
  int threads = 1, warm_up = 20, repeats = 5;
};

/// Cores of this machine, regardless of binding.
int cores() { return static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)); }

/// Ranks on this rank's machine. Collective.
int ranks_here(core::Communication& communication) {
  char name[256] = {};
  gethostname(name, sizeof name - 1);
  const std::vector<std::string> names = communication.reductions.gather(name);
  return static_cast<int>(std::count(names.begin(), names.end(), std::string(name)));
}

Json to_json(const core::Spread& s) { return {{"min", s.min}, {"mean", s.mean}, {"max", s.max}}; }

/// Seconds per step of one repeat.
struct Repeat {
  double step = 0;       ///< of the slowest rank
  core::Spread compute;  ///< over the ranks
  std::array<core::Spread, TimedCommunication::parts> parts;
};

/// Steps of one sorting interval. `by_processor`: more threads than cores. Collective.
Repeat repeat(BarRun& bar, TimedCommunication& communication, int threads, bool by_processor) {
  constexpr int steps = core::Stepper::sorting_interval;
  communication.reductions.any(false);  // all start together
  communication.take();
  const double process = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
  const Seconds start = Seconds::now();
  for (int i = 0; i < steps; ++i) bar.stepper->step();
  const Seconds passed = Seconds::now() - start;
  const double process_passed = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - process;
  const TimedCommunication::Times times = communication.take();
  Seconds talk;
  for (const Seconds& t : times) talk += t;
  const double busy = by_processor   ? (process_passed - talk.cpu) / threads
                      : threads == 1 ? passed.cpu - talk.cpu
                                     : passed.wall - talk.wall;
  Repeat r;
  r.compute = communication.reductions.spread(busy / steps);
  r.step = by_processor ? r.compute.max : communication.reductions.spread(passed.wall / steps).max;
  for (std::size_t p = 0; p < times.size(); ++p) {
    r.parts[p] = communication.reductions.spread((by_processor ? times[p].cpu : times[p].wall) / steps);
  }
  return r;
}

/// Collective.
Json measure(const Options& o, const parallel::Communicator& world) {
  parallel::MpiCommunication ranks(world);
  TimedCommunication communication(ranks);
  omp_set_num_threads(o.threads);
  const bool crowded = ranks_here(ranks) * o.threads > cores();
  BarInput input{.particles = o.particles, .scheme = o.scheme};
  input.more = fmt::format(R"(<DomainDecomposition method="{}"/>)", o.partition);
  BarRun bar(input.scene(), communication);
  for (int i = 0; i < o.warm_up; ++i) bar.stepper->step();

  Series steps;
  Repeat best;
  for (int i = 0; i < o.repeats; ++i) {
    const Repeat r = repeat(bar, communication, o.threads, crowded);
    steps.add(r.step);
    if (steps.index_of_best() + 1 == steps.size()) best = r;
  }
  const auto particles = ranks.reductions.spread(bar.particles());
  const auto bricks = ranks.reductions.spread(bar.model.grid->owned());
  Json parts;
  for (std::size_t p = 0; p < best.parts.size(); ++p)
    parts[std::string(TimedCommunication::part_names[p])] = to_json(best.parts[p]);
  Json facts;
  for (const auto& [name, value] : machine_facts()) facts[name] = value;
  return {{"ranks", ranks.reductions.size()},
          {"threads", o.threads},
          {"cores", cores()},
          {"oversubscribed", crowded},
          {"clock", crowded ? "processor" : "wall"},
          {"partition", o.partition},
          {"scheme", o.scheme},
          {"particles", particles.mean * ranks.reductions.size()},
          {"bricks", bricks.mean * ranks.reductions.size()},
          {"particle_imbalance", particles.max / particles.mean},
          {"repeats", o.repeats},
          {"step_s", steps.best()},
          {"step_median_s", steps.median()},
          {"compute_s", to_json(best.compute)},
          {"imbalance", best.compute.max / best.compute.mean},
          {"parts_s", parts},
          {"state", fmt::format("{:016x}", io::state_hash(bar.model, ranks))},
          {"facts", facts}};
}

int run(int argc, char** argv, const parallel::Communicator& world) {
  Options o;
  CLI::App app("One case of a scaling study of the copper Taylor bar, as a line of JSON.", "scaling");
  app.add_option("--particles", o.particles)->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--scheme", o.scheme, "MUSL, USF, USL")->capture_default_str();
  app.add_option("--partition", o.partition, "metis, uniform")->capture_default_str();
  app.add_option("--threads", o.threads, "per rank")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--warm-up", o.warm_up, "steps before the first that counts")->capture_default_str();
  app.add_option("--repeats", o.repeats, "of 20 steps")->check(CLI::PositiveNumber)->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) { return world.rank() == 0 ? app.exit(e) : e.get_exit_code(); }
  const Json result = measure(o, world);
  if (world.rank() == 0) fmt::print("{}\n", result.dump());
  return 0;
}

}  // namespace
}  // namespace mpm::benchmarks

int main(int argc, char** argv) {
  using namespace mpm;
  const parallel::Environment environment(argc, argv);
  const parallel::Communicator world = parallel::Communicator::world();
  try {
    return benchmarks::run(argc, argv, world);
  } catch (const core::InputErrors& e) {  // the same on every rank
    if (world.rank() == 0) fmt::print(stderr, "{}\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    fmt::print(stderr, "rank {}: {}\n", world.rank(), e.what());
    parallel::abort(1);
  }
}
