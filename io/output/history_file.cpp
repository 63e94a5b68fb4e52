#include "io/output/history_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/particle_range.hpp"
#include "core/step/finite.hpp"
#include "io/output/hash.hpp"
#include "io/output/narrowing.hpp"
#include "io/output/provenance.hpp"

namespace mpm::io {

using core::Column;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int width = 24;

// Record of a target: found (0, or infinity on ranks that do not have it), its brick, its variables. The
// minimum over the ranks gives the values of the rank that has it.
constexpr std::size_t place_entry = 1;
constexpr std::size_t first_value = 4;

/// Search distance from the last position of a particle.
enum Reach { same_brick, neighbour_bricks, everywhere };

/// A particle and its body.
struct Found {
  core::ConstParticle particle;
  int body = 0;
};

std::optional<Found> find_in(const core::Model& model, const core::Brick& brick, std::uint64_t identity) {
  const auto wanted = static_cast<double>(identity);
  for (const core::ConstParticleBlock& block : core::blocks_of(model, brick)) {
    for (const core::ConstParticle p : block) {
      if (p[Column::identity] == wanted) return Found{p, block.body};
    }
  }
  return std::nullopt;
}

/// Slots of this rank where a particle last seen in brick `b` may be.
std::vector<core::Slot> candidates(const core::BrickGrid& grid, const std::optional<core::BrickCoord>& b,
                                   int reach) {
  std::vector<core::Slot> slots;
  if (reach == everywhere) {
    for (core::Slot s = 0; s < grid.owned(); ++s) slots.push_back(s);
  } else if (b) {
    for (int n = 0; n < core::neighbourhood; ++n) {
      if (reach == same_brick && n != core::self_index) continue;
      const core::Slot s = grid.find(*b + core::neighbour_offset(n));
      if (s != core::no_slot && s < grid.owned()) slots.push_back(s);
    }
  }
  return slots;
}

/// A ratio or a square may overflow although its operands are finite.
double finite(double value) {
  std::int64_t cut = 0;
  return narrowed<double>(value, cut);
}

/// Of the bodies of all histories.
std::vector<ReactionColumns> reactions_of(const core::Model& model) {
  std::vector<ReactionColumns> columns;
  for (const core::TimeHistoryInput& history : model.scene->output.histories) {
    for (const std::string& name : history.bodies) {
      const auto found = std::ranges::find_if(model.reactions, [&](const core::Reaction& r) {
        return model.bodies[static_cast<std::size_t>(r.body)].name == name;
      });
      if (found == model.reactions.end()) continue;
      columns.push_back(
          {static_cast<std::size_t>(found - model.reactions.begin()), history.force, history.moment});
    }
  }
  return columns;
}

using Words = std::span<const std::uint64_t>;

/// Of HistoryFile::tracked(). Files of earlier versions begin with an identity or with the bits of a time.
constexpr std::uint64_t format_mark = 0xfff0'6869'7374'0001u;

std::uint64_t hash_of(const std::vector<Variable>& variables) {
  Hash hash;
  for (const Variable v : variables) hash.add(info_of(v).name);
  return hash.value();
}

/// A particle in tracked().
struct Memory {
  core::Vec3<double> place{};
  std::uint64_t variables = 0, identity = no_identity;
  bool present = false;
  std::vector<double> values;
};

/// Removes up to `n` words from the front.
Words take(Words& words, std::uint64_t n) {
  const Words taken = words.first(std::min<std::uint64_t>(n, words.size()));
  words = words.subspan(taken.size());
  return taken;
}
std::uint64_t take_one(Words& words) {
  const Words taken = take(words, 1);
  return taken.empty() ? 0 : taken[0];
}

std::vector<Memory> take_memories(Words& words) {
  std::vector<Memory> memories;
  for (std::uint64_t n = take_one(words); n > 0 && !words.empty(); --n) {
    Memory& m = memories.emplace_back();
    for (int a = 0; a < 3; ++a) m.place[a] = std::bit_cast<double>(take_one(words));
    m.variables = take_one(words);
    m.identity = take_one(words);
    m.present = take_one(words) != 0;
    for (const std::uint64_t value : take(words, take_one(words)))
      m.values.push_back(std::bit_cast<double>(value));
  }
  return memories;
}

double squared_distance(const core::Vec3<double>& a, const core::Vec3<double>& b) {
  const core::Vec3<double> d = a - b;
  return dot(d, d);
}

}  // namespace

HistoryFile::HistoryFile(const std::string& path, const core::Model& model,
                         std::optional<Continuation> continuation, core::Reductions& ranks)
    : targets_(targets_of(*model.scene)), reactions_(reactions_of(model), model), forces_(*model.scene) {
  for (Target& t : targets_) {
    t.first = record_;
    record_ += first_value + t.variables.size();
    t.values.resize(t.variables.size());
  }
  reactions_.begin(model, ranks);
  forces_.begin(model, ranks);
  if (continuation) recall(continuation->tracked);
  choose_particles(model, ranks);
  std::optional<TableContinuation> rows;
  if (continuation) rows = continuation->rows;
  const std::string comments =
      to_text(provenance_of(*model.scene), "# ") + reactions_.legend() + forces_.legend();
  file_.emplace(path, comments, legend(), head(), rows, ranks);
}

/// A target is recalled by its place: the input of a restart may have others, or in another order.
void HistoryFile::recall(const std::vector<std::uint64_t>& tracked) {
  Words words(tracked);
  if (take_one(words) != format_mark) return;
  const std::vector<Memory> memories = take_memories(words);
  for (Target& t : targets_) {
    if (!t.particle) continue;
    for (const Memory& m : memories) {
      if (m.place != t.point) continue;
      const bool same_variables = m.variables == hash_of(t.variables) && m.values.size() == t.values.size();
      if (t.recalled && !same_variables) continue;
      t.recalled = true;
      t.identity = m.identity;
      t.present = m.present;
      if (same_variables) t.values = m.values;
      if (same_variables) break;
    }
  }
  for (IntervalMeans* means : {&reactions_.means(), &forces_.means()})
    means->recall(take(words, take_one(words)));
}

std::vector<HistoryFile::Target> HistoryFile::targets_of(const core::Scene& scene) {
  std::vector<Target> targets;
  for (const core::TimeHistoryInput& history : scene.output.histories) {
    const std::vector<Variable> variables = variables_of(history.variables);
    for (const auto& p : history.particles)
      targets.push_back({p, true, variables, 0, no_identity, false, false, {}, {}});
    for (const auto& p : history.points)
      targets.push_back({p, false, variables, 0, no_identity, false, false, {}, {}});
  }
  return targets;
}

void HistoryFile::choose_particles(const core::Model& model, core::Reductions& ranks) {
  const auto needs_one = [](const Target& t) { return t.particle && !t.recalled; };
  if (std::ranges::none_of(targets_, needs_one)) return;
  std::vector<double> nearest(targets_.size(), infinity), identity(targets_.size(), infinity),
      volume(targets_.size(), infinity);
  for (const core::ConstParticleBlock& block : core::blocks_of(model)) {
    for (const core::ConstParticle p : block) {
      for (std::size_t i = 0; i < targets_.size(); ++i) {
        const double d = squared_distance(p.vector(Column::position_x), targets_[i].point);
        if (d > nearest[i]) continue;
        const double id = p[Column::identity];
        if (d < nearest[i] || id < identity[i]) {
          identity[i] = id;
          volume[i] = p[Column::volume];
        }
        nearest[i] = d;
      }
    }
  }
  const std::vector<double> mine = nearest;
  ranks.minimum(nearest);
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    if (mine[i] != nearest[i]) identity[i] = infinity;
  }
  const std::vector<double> my_identity = identity;
  ranks.minimum(identity);
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    if (my_identity[i] != identity[i]) volume[i] = infinity;
  }
  ranks.minimum(volume);
  int particles = 0;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    Target& t = targets_[i];
    if (t.particle) ++particles;
    if (!needs_one(t) || identity[i] == infinity) continue;
    t.identity = static_cast<std::uint64_t>(identity[i]);
    t.present = true;
    const double distance = std::sqrt(nearest[i]), spacing = std::cbrt(volume[i]);
    if (distance > spacing)
      chosen_far_.push_back(
          fmt::format("particle{} of the time histories, the one nearest to ({:.9g}, {:.9g}, {:.9g}), is "
                      "{:.4g} away, more than the distance {:.4g} of particles: no body is at this point",
                      particles, t.point.x, t.point.y, t.point.z, distance, spacing));
    if (model.clock.step > 0)
      chosen_late_.push_back(fmt::format(
          "particle{} of the time histories is the one nearest to ({:.9g}, {:.9g}, {:.9g}) at the "
          "restart, identity {}",
          particles, t.point.x, t.point.y, t.point.z, t.identity));
  }
}

std::string HistoryFile::head() const {
  std::string head = fmt::format("#{:>{}}", "step", width - 1);
  const auto add = [&](const std::string& name) { head += fmt::format(" {:>{}}", name, width); };
  for (const char* name : {"time", "kinetic", "internal"}) add(name);
  int particles = 0, points = 0;
  for (const Target& t : targets_) {
    const int n = t.particle ? ++particles : ++points;
    for (const Variable v : t.variables) {
      add(fmt::format("{}[{}{}]", info_of(v).name, t.particle ? "particle" : "point", n));
    }
    if (t.particle) add(fmt::format("present[particle{}]", n));
  }
  for (const std::string& column : reactions_.names()) add(column);
  for (const std::string& column : forces_.columns()) add(column);
  return head;
}

std::string HistoryFile::legend() const {
  std::string text;
  int particles = 0, points = 0;
  for (const Target& t : targets_) {
    const std::string where = fmt::format("({:.9g}, {:.9g}, {:.9g})", t.point.x, t.point.y, t.point.z);
    if (!t.particle) {
      text += fmt::format("# point{}: the cell around {}\n", ++points, where);
    } else if (t.identity == no_identity) {
      text += fmt::format("# particle{}: none, for {}\n", ++particles, where);
    } else {
      text += fmt::format("# particle{}: identity {}, nearest to {}\n", ++particles, t.identity, where);
    }
  }
  if (particles > 0)
    text +=
        "# present[particle]: 1; 0 once it is eroded or has left the grid; its other columns then keep their "
        "last values\n";
  return text;
}

void HistoryFile::look_up(const core::Model& model, int reach, std::vector<double>& values) const {
  for (const Target& t : targets_) {
    double* record = &values[t.first];
    if (!t.particle || !t.present || *record == 0) continue;
    for (const core::Slot s : candidates(*model.grid, t.last, reach)) {
      const auto found = find_in(model, model.grid->brick(s), t.identity);
      if (!found) continue;
      const core::BrickCoord b = model.grid->brick(s).coord;
      record[0] = 0;
      record[place_entry] = b.x;
      record[place_entry + 1] = b.y;
      record[place_entry + 2] = b.z;
      const BodyFacts facts = facts_of(model, static_cast<std::size_t>(found->body));
      for (std::size_t v = 0; v < t.variables.size(); ++v) {
        record[first_value + v] = finite(evaluate(t.variables[v], found->particle, facts));
      }
      break;
    }
  }
}

namespace {

/// The bricks whose particles may be in the cell of a point: around it are the nodes of up to eight.
std::vector<core::BrickCoord> bricks_around(const core::GridGeometry& geometry, const core::Vec3<double>& x) {
  if (geometry.site == core::Site::cell) return {geometry.brick_at(x)};
  std::vector<core::BrickCoord> bricks;
  for (int corner = 0; corner < 8; ++corner) {
    std::int32_t b[3];
    for (int a = 0; a < 3; ++a)
      b[a] =
          static_cast<std::int32_t>((geometry.cell_index(x[a], a) + (corner >> a & 1)) / core::brick_cells);
    const core::BrickCoord brick{b[0], b[1], b[2]};
    if (std::ranges::find(bricks, brick) == bricks.end()) bricks.push_back(brick);
  }
  return bricks;
}

}  // namespace

void HistoryFile::average(const core::Model& model, core::Reductions& ranks,
                          std::vector<double>& values) const {
  const core::GridGeometry& geometry = model.grid->geometry();
  std::vector<core::ExactSum> sums;  // by point: of weights, then of weight times variable
  for (const Target& t : targets_) {
    if (t.particle || !geometry.contains(t.point)) continue;
    const std::size_t first = sums.size();
    sums.resize(first + 1 + t.variables.size());
    for (const core::BrickCoord& brick : bricks_around(geometry, t.point)) {
      const core::Slot s = model.grid->find(brick);
      if (s == core::no_slot || s >= model.grid->owned()) continue;
      for (const core::ConstParticleBlock& block : core::blocks_of(model, model.grid->brick(s))) {
        const BodyFacts facts = facts_of(model, static_cast<std::size_t>(block.body));
        for (const core::ConstParticle p : block) {
          const core::Vec3<double> x = p.vector(Column::position_x);
          double w = p[Column::mass];
          for (int a = 0; a < 3; ++a) {
            w *= geometry.cell_index(x[a], a) == geometry.cell_index(t.point[a], a)
                     ? std::fmax(0.0, 1 - std::abs(x[a] - t.point[a]) * geometry.inverse_cell[a])
                     : 0.0;
          }
          if (w == 0) continue;
          sums[first].add(w);
          for (std::size_t v = 0; v < t.variables.size(); ++v)
            sums[first + 1 + v].add(w * finite(evaluate(t.variables[v], p, facts)));
        }
      }
    }
  }
  if (sums.empty()) return;
  ranks.sum(std::span(sums));
  auto next = sums.begin();
  for (const Target& t : targets_) {
    if (t.particle || !geometry.contains(t.point)) continue;
    const double weights = (next++)->value();
    if (weights > 0) values[t.first] = 0;
    for (std::size_t v = 0; v < t.variables.size(); ++v, ++next)
      if (weights > 0) values[t.first + first_value + v] = finite(next->value() / weights);
  }
}

void HistoryFile::add(const core::Model& model, core::Reductions& ranks) {
  const core::Energies energies = core::compute_energies(model, ranks);
  core::require_finite(model, std::array{energies.kinetic, energies.internal}, ranks);
  add(model, energies, ranks);
}

void HistoryFile::add(const core::Model& model, const core::Energies& energies, core::Reductions& ranks) {
  std::vector<double> values(record_, infinity);
  average(model, ranks, values);
  const auto missing = [&] {
    return std::any_of(targets_.begin(), targets_.end(),
                       [&](const Target& t) { return t.particle && t.present && values[t.first] != 0; });
  };
  for (int reach = same_brick; reach <= everywhere && (reach == same_brick || missing()); ++reach) {
    look_up(model, reach, values);
    ranks.minimum(values);
  }

  std::string row = fmt::format("{:>{}}", model.clock.step, width);
  const auto put = [&](double value) { row += fmt::format(" {:>{}.16e}", value, width); };
  for (const double value : {model.clock.time, energies.kinetic, energies.internal}) put(value);
  gone_.clear();
  int particles = 0;
  for (Target& t : targets_) {
    const double* record = &values[t.first];
    const bool found = record[0] == 0;
    for (std::size_t v = 0; v < t.values.size(); ++v) {
      if (found || !t.particle) t.values[v] = found ? record[first_value + v] : 0.0;
      put(t.values[v]);
    }
    if (!t.particle) continue;
    ++particles;
    row += fmt::format(" {:>{}}", found ? 1 : 0, width);
    if (found) {
      const double* b = record + place_entry;
      t.last = {static_cast<std::int32_t>(b[0]), static_cast<std::int32_t>(b[1]),
                static_cast<std::int32_t>(b[2])};
    } else if (t.present) {
      t.present = false;
      gone_.push_back(
          fmt::format("step {}, time {:.6g}: particle{} of the time histories (identity {}) is eroded or has "
                      "left the grid; "
                      "its columns keep their last values",
                      model.clock.step, model.clock.time, particles, t.identity));
    }
  }
  for (const double value : reactions_.next(model, ranks)) put(value);
  for (const double force : forces_.next(model, ranks)) put(force);
  file_->add(model.clock.step, row);
}

std::vector<std::uint64_t> HistoryFile::tracked() const {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  std::vector<std::uint64_t> memory{format_mark, 0};
  for (const Target& t : targets_) {
    if (!t.particle) continue;
    ++memory[1];
    memory.insert(memory.end(), {bits(t.point.x), bits(t.point.y), bits(t.point.z), hash_of(t.variables),
                                 t.identity, std::uint64_t{t.present}, t.values.size()});
    for (const double value : t.values) memory.push_back(bits(value));
  }
  for (const IntervalMeans* means : {&reactions_.means(), &forces_.means()}) {
    const std::vector<std::uint64_t> of_means = means->memory();
    memory.push_back(of_means.size());
    memory.insert(memory.end(), of_means.begin(), of_means.end());
  }
  return memory;
}

}  // namespace mpm::io
