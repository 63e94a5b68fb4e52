// Cost of each law and each optional feature, in bytes per particle and nanoseconds per particle-step: the
// copper Taylor bar with and without it, in one process, stepped alternately. Times are CPU times of this
// thread. The scenes alternate every twenty steps, A B A B ... A. Each B is compared with the mean of the A
// before and after it, so that a drift of the machine cancels; the result is the median of these differences
// with its standard error. The row "the same scene twice" shows the noise of the method. Settings without
// effect must cost nothing: the same bytes and a bitwise identical state after the same steps; otherwise the
// program exits with code 1.
//
// The laws are those of the catalogue, with the parameters of tests/physics/samples.cpp. Each law is also
// timed alone: Material::update on batches in cache.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <omp.h>

#include "benchmarks/common/clock.hpp"
#include "benchmarks/common/features.hpp"
#include "benchmarks/common/table_file.hpp"
#include "core/particle_range.hpp"
#include "core/simd/denormals.hpp"
#include "io/output/particle_order.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::benchmarks {
namespace {

struct Options {
  double particles = 100e3;
  int pairs = 8, warm_up = 20;
  std::vector<std::string> families, only;
  std::string csv;
};

/// Two scenes, the second with the feature; for a law also the law alone.
struct Case {
  std::string family, name, against;
  std::function<core::Scene()> without, with;
  std::optional<core::MaterialInput> law{};
  bool asks_for_nothing = false;
};

struct Row {
  Case of;
  double ns = 0;  ///< with the feature
  double added_ns = 0, error_ns = 0;
  double state_bytes = 0, added_state_bytes = 0;
  double held_bytes = 0, added_held_bytes = 0;  ///< blocks that are not full included
  bool same_bits = false;
  double law_ns = std::nan("");
};

/// The bar of another material with an impact velocity of a twentieth of its sound speed, at most 190 m/s;
/// `like` sets the velocity. An explosive is lit at the foot.
core::Scene bar_of(const core::MaterialInput& si, const core::MaterialInput& like, double particles) {
  core::Scene scene = BarInput{.particles = particles}.scene();
  const core::MaterialInput material = tests::convert(si, tests::mm_g_ms);
  const double c = tests::make(tests::convert(like, tests::mm_g_ms))->initial_sound_speed();
  scene.materials[0] = material;
  scene.detonations.emplace_back().time = -1;
  core::BodyInput& body = scene.components[0].bodies[0];
  body.density = material.reference_density;
  body.initial_velocity = {0, 0, -std::min(190.0, 0.05 * c)};
  return scene;
}

/// Reference for a law: the first of these that is a valid material.
struct Base {
  core::MaterialInput input;
  std::string name;
};
Base first_possible(const std::vector<Base>& bases) {
  for (const Base& base : bases) {
    try {
      tests::make(base.input);
      return base;
    } catch (const core::InputErrors&) {}  // say, a fluid without its equation of state
  }
  return bases.back();
}

/// Each law once, from the first sample that has it: a strength law against an elastic solid, an equation of
/// state against the elastic bulk, a failure model against none.
std::vector<Case> law_cases(double particles) {
  const core::LawInput elastic{"IsoElastic", {{"Young", 124e9}, {"Poisson", 0.34}}, {}};
  using Key = std::pair<std::string, core::ParameterValues>;
  std::map<std::string, std::set<Key>> seen;
  std::vector<Case> cases;
  for (const tests::Sample& s : tests::samples()) {
    if (!s.solid) continue;  // not a bar of particles
    const auto add = [&](const std::string& family, const core::LawInput& law,
                         const std::vector<Base>& bases) {
      if (!seen[family].insert({law.type, law.values}).second) return;
      const Base base = first_possible(bases);
      cases.push_back({family, s.label, base.name, [=] { return bar_of(base.input, s.input, particles); },
                       [=] { return bar_of(s.input, s.input, particles); }, s.input});
    };
    Base plain{s.input, "without"}, of_strength{s.input, "IsoElastic"}, of_eos{s.input, "elastic bulk"};
    plain.input.failures.clear();
    of_strength.input.strength = elastic;
    of_eos.input.eos.reset();
    Base simple{of_eos.input, "IsoElastic, elastic bulk"};
    simple.input.strength = elastic;
    if (!s.input.failures.empty()) {
      add("failure law", s.input.failures.front(), {plain});
      continue;
    }
    add("strength law", s.input.strength, {of_strength, simple});
    if (s.input.eos) add("equation of state", *s.input.eos, {of_eos, simple});
  }
  return cases;
}

/// Material::update alone, ns per particle: 1024 particles in the L2 cache under cyclic deformation of 2 %.
double time_of_law(const core::MaterialInput& si) {
  constexpr int batches = 16, sweeps = 50;
  const auto model = tests::make(tests::convert(si, tests::mm_g_ms));
  const core::UpdateOptions options;
  core::ColumnSet columns = core::ColumnSet::mechanics();
  columns.add(model->columns(options));
  const core::ColumnLayout layout(columns);
  core::AlignedDoubles state;
  const auto doubles = static_cast<std::size_t>(layout.block_doubles());
  state.resize(doubles * core::batch_blocks * batches);
  std::fill_n(state.data(), doubles * core::batch_blocks * batches, 0.0);
  const auto batch = std::make_unique<core::Batch>();
  batch->layout = &layout;
  batch->blocks = core::batch_blocks;
  batch->particles = core::batch_particles;
  batch->cell_size = 0.5;
  batch->dt = 0.4 * batch->cell_size / std::max(model->initial_sound_speed(), 1.0);
  const auto point_at = [&](int b) {
    for (int i = 0; i < core::batch_blocks; ++i)
      batch->block[i] = state.data() + doubles * static_cast<std::size_t>(core::batch_blocks * b + i);
  };
  const auto deform = [&](double rate) {
    constexpr double shape[9] = {-1, 0.5, 0, 0.3, 0.4, 0, 0, 0.1, 0.3};
    for (int c = 0; c < 9; ++c) std::fill_n(batch->gradient[c], core::batch_particles, rate * shape[c]);
    std::fill_n(batch->cell_volumetric_strain, core::batch_particles, -0.3 * rate * batch->dt);
  };
  for (int b = 0; b < batches; ++b) {
    point_at(b);
    for (int i = 0; i < core::batch_blocks; ++i) {
      std::fill_n(batch->column(core::Column::volume, i), core::block_lanes, 1.0);
      std::fill_n(batch->column(core::Column::mass, i), core::block_lanes, model->reference_density());
    }
    model->initialise(*batch, options);
  }
  double rate = 0.02 / (sweeps * batch->dt);
  Series ns;
  for (int repeat = 0; repeat < 40; ++repeat, rate = -rate) {
    deform(rate);
    const Seconds before = Seconds::now();
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      for (int b = 0; b < batches; ++b) {
        point_at(b);
        model->update(*batch, options);
      }
      batch->time += batch->dt;
    }
    ns.add(1e9 * (Seconds::now() - before).cpu / (sweeps * batches * core::batch_particles));
  }
  return ns.best();
}

/// A scene that alternates with another.
class Contestant {
 public:
  Contestant(core::Scene scene, int warm_up) : bar_(endless(std::move(scene))) {
    for (int i = 0; i < warm_up; ++i) bar_.stepper->step();
  }
  /// ns per particle-step over one sorting interval.
  double run() {
    constexpr int steps = core::Stepper::sorting_interval;
    const double particles = bar_.particles();
    const Seconds before = Seconds::now();
    for (int i = 0; i < steps; ++i) bar_.stepper->step();
    return 1e9 * (Seconds::now() - before).cpu / (particles * steps);
  }
  double state_bytes() const {
    double bytes = 0;
    for (const core::ConstParticleBlock& block : core::blocks_of(bar_.model))
      bytes += block.used * block.layout->bytes_per_particle();
    return bytes / bar_.particles();
  }
  double held_bytes() const { return bar_.state_bytes() / bar_.particles(); }
  std::uint64_t hash() { return io::state_hash(bar_.model, bar_.alone); }

 private:
  BarRun bar_;
};

Row measure(const Case& c, const Options& o) {
  Contestant a(c.without(), o.warm_up), b(c.with(), o.warm_up);
  Row row{c};
  Series with, differences;
  double before = a.run();
  for (int i = 0; i < o.pairs; ++i) {
    with.add(b.run());
    const double after = a.run();
    differences.add(with.last() - 0.5 * (before + after));
    before = after;
  }
  b.run();  // as many steps as the other
  row.ns = with.median();
  row.added_ns = differences.median();
  row.error_ns = differences.error_of_median();
  row.state_bytes = b.state_bytes();
  row.added_state_bytes = b.state_bytes() - a.state_bytes();
  row.held_bytes = b.held_bytes();
  row.added_held_bytes = b.held_bytes() - a.held_bytes();
  row.same_bits = a.hash() == b.hash();
  if (c.law) row.law_ns = time_of_law(*c.law);
  return row;
}

void print(const Row& r) {
  fmt::print("{:<18} {:<42} {:<16} {:>7.2f} {:>+7.2f} +-{:>5.2f} {:>6} {:>5.0f} {:>+5.0f} {:>+7.1f}{}\n",
             r.of.family, r.of.name, r.of.against, r.ns, r.added_ns, r.error_ns,
             std::isnan(r.law_ns) ? "" : fmt::format("{:.2f}", r.law_ns), r.state_bytes, r.added_state_bytes,
             r.added_held_bytes, r.same_bits ? "  same bits" : "");
  std::fflush(stdout);
}

void write_csv(const std::string& path, const Options& o, const std::vector<Row>& rows,
               const std::vector<std::pair<std::string, std::string>>& left_out) {
  Facts facts = machine_facts();
  facts.emplace_back("case", fmt::format("{:.0f} particles, {} pairs of {} steps", o.particles, o.pairs,
                                         core::Stepper::sorting_interval));
  for (const auto& [name, why] : left_out) facts.emplace_back("left out", name + ": " + why);
  const TableFile file(path, facts);
  fmt::print(file.handle,
             "family,feature,against,ns,added_ns,error_ns,law_ns,state_bytes,added_state_bytes,held_bytes,"
             "added_held_bytes,same_bits\n");
  for (const Row& r : rows) {
    fmt::print(file.handle,
               "\"{}\",\"{}\",\"{}\",{:.4g},{:.4g},{:.3g},{:.4g},{:.0f},{:.0f},{:.1f},{:.1f},{:d}\n",
               r.of.family, r.of.name, r.of.against, r.ns, r.added_ns, r.error_ns, r.law_ns, r.state_bytes,
               r.added_state_bytes, r.held_bytes, r.added_held_bytes, r.same_bits);
  }
}

std::vector<Case> all_cases(const Options& o) {
  std::vector<Case> cases;
  const auto scene = [&](BarInput input) {
    input.particles = o.particles;
    return [input] { return input.scene(); };
  };
  const auto add = [&](const std::vector<Feature>& of, bool nothing) {
    for (const Feature& f : of)
      cases.push_back({f.family, f.name, f.against, scene(f.without), scene(f.with), {}, nothing});
  };
  add(features(), false);
  for (Case& c : law_cases(o.particles)) cases.push_back(std::move(c));
  add(spelled_out(), true);
  std::erase_if(cases, [&](const Case& c) {
    const auto has = [](const std::vector<std::string>& words, const auto& holds) {
      return words.empty() || std::any_of(words.begin(), words.end(), holds);
    };
    return !has(o.families, [&](const std::string& w) { return c.family == w; }) ||
           !has(o.only, [&](const std::string& w) { return c.name.find(w) != std::string::npos; });
  });
  return cases;
}

Options parse(int argc, char** argv) {
  Options o;
  CLI::App app("What laws and features add to a step, in bytes and nanoseconds.", "feature_cost");
  app.add_option("--particles", o.particles)->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--pairs", o.pairs, "of 20 steps with and 20 without")
      ->check(CLI::Range(2, 10000))
      ->capture_default_str();
  app.add_option("--warm-up", o.warm_up, "steps before the first that counts")->capture_default_str();
  app.add_option("--families", o.families, "only these")->delimiter(',');
  app.add_option("--only", o.only, "only features with one of these words in their name")->delimiter(',');
  app.add_option("--csv", o.csv, "file for the results");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) { std::exit(app.exit(e)); }
  return o;
}

int run(int argc, char** argv) {
  const Options o = parse(argc, argv);
  omp_set_num_threads(1);
  core::flush_denormals_to_zero();
  fmt::print(
      "{}\nns are of one core per particle-step; bytes per particle, held: blocks that are not full "
      "included\n",
      facts_as_text(machine_facts(), ""));
  fmt::print("{:<18} {:<42} {:<16} {:>7} {:>7} {:>7} {:>6} {:>5} {:>5} {:>7}\n", "family", "feature",
             "against", "ns", "added", "error", "alone", "bytes", "added", "held");
  std::vector<Row> rows;
  std::vector<std::pair<std::string, std::string>> left_out;
  int wrong = 0;
  for (const Case& c : all_cases(o)) {
    try {
      rows.push_back(measure(c, o));
      print(rows.back());
      const bool free = rows.back().same_bits && rows.back().added_state_bytes == 0;
      if (c.asks_for_nothing && !free) {
        fmt::print("WRONG: it asks for nothing, and is not for nothing\n");
        ++wrong;
      }
    } catch (const std::exception& e) {
      std::string why = e.what();
      std::replace(why.begin(), why.end(), '\n', ' ');  // one line of the table's head
      left_out.emplace_back(c.family + " " + c.name, why);
    }
  }
  for (const auto& [name, why] : left_out) fmt::print("left out: {}: {}\n", name, why);
  if (!o.csv.empty()) write_csv(o.csv, o, rows, left_out);
  return wrong > 0 || rows.empty() ? 1 : 0;
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
