#include "core/step/totals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "core/particle_range.hpp"
#include "core/threads.hpp"

namespace mpm::core {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

enum Sum : std::size_t {
  mass,
  kinetic,
  internal,
  momentum,                         // three
  angular_momentum = momentum + 3,  // three
  moment = angular_momentum + 3,    // mass times position, three
  sums = moment + 3
};
enum Low : std::size_t { lower, upper = lower + 3, plastic_strain = upper + 3, temperature, lows };

/// Partial sums of one body by one thread. Maxima are stored as minima of the negative.
struct Partial {
  std::array<ExactSum, sums> sum;
  std::array<double, lows> low{};
  std::int64_t particles = 0;
  std::int64_t failed = 0;

  Partial() { low.fill(infinity); }
  void merge(const Partial& other) {
    for (std::size_t i = 0; i < sums; ++i) sum[i] += other.sum[i];
    for (std::size_t i = 0; i < lows; ++i) low[i] = std::min(low[i], other.low[i]);
    particles += other.particles;
    failed += other.failed;
  }
};

struct BlockEnergies {
  double kinetic = 0, internal = 0;
};
/// Not inlined: both callers must get the same bits, whichever operations the compiler contracts.
[[gnu::noinline]] BlockEnergies energies_of(const ColumnLayout& layout, const double* block, int used,
                                            double inverse_density) {
  const double* m = block + layout.offset(Column::mass);
  const double* e = block + layout.offset(Column::internal_energy);
  const double* v = block + layout.offset(Column::velocity_x);
  constexpr int y = block_lanes, z = 2 * block_lanes;
  BlockEnergies sum;
  for (int i = 0; i < used; ++i) {
    sum.kinetic += 0.5 * m[i] * (v[i] * v[i] + v[i + y] * v[i + y] + v[i + z] * v[i + z]);
    sum.internal += e[i] * m[i] * inverse_density;
  }
  return sum;
}

void note_lowest(const double* column, int used, double sign, double& low) {
  for (int i = 0; i < used; ++i) low = sign * column[i] < low ? sign * column[i] : low;
}

void add_block(const ColumnLayout& layout, const double* block, int used, double inverse_density,
               Partial& to) {
  const auto column = [&](Column c) { return block + layout.offset(c); };
  const double* m = column(Column::mass);
  const double* x = column(Column::position_x);
  const double* v = column(Column::velocity_x);
  constexpr int y = block_lanes, z = 2 * block_lanes;
  double s[sums] = {};
  const BlockEnergies energies = energies_of(layout, block, used, inverse_density);
  s[kinetic] = energies.kinetic;
  s[internal] = energies.internal;
  for (int i = 0; i < used; ++i) {
    const double px = m[i] * v[i], py = m[i] * v[i + y], pz = m[i] * v[i + z];
    s[mass] += m[i];
    s[momentum] += px;
    s[momentum + 1] += py;
    s[momentum + 2] += pz;
    s[angular_momentum] += x[i + y] * pz - x[i + z] * py;
    s[angular_momentum + 1] += x[i + z] * px - x[i] * pz;
    s[angular_momentum + 2] += x[i] * py - x[i + y] * px;
    s[moment] += m[i] * x[i];
    s[moment + 1] += m[i] * x[i + y];
    s[moment + 2] += m[i] * x[i + z];
  }
  for (std::size_t k = 0; k < sums; ++k) to.sum[k].add(s[k]);
  for (std::size_t a = 0; a < 3; ++a) {
    note_lowest(x + block_lanes * a, used, 1, to.low[lower + a]);
    note_lowest(x + block_lanes * a, used, -1, to.low[upper + a]);
  }
  if (layout.has(Column::effective_plastic_strain)) {
    note_lowest(column(Column::effective_plastic_strain), used, -1, to.low[plastic_strain]);
  }
  if (layout.has(Column::temperature))
    note_lowest(column(Column::temperature), used, -1, to.low[temperature]);
  if (layout.has(Column::failed)) {
    for (int i = 0; i < used; ++i) to.failed += column(Column::failed)[i] >= 1;
  }
  to.particles += used;
}

/// f(brick, own partial result) over this rank's bricks by all threads; merges the partial results into
/// `out`, which is empty at first.
template <class P, class F>
void over_bricks(const Model& model, P& out, F f) {
  std::vector<P> partial(static_cast<std::size_t>(omp_get_max_threads()), out);
  for_each_by_threads(0, model.grid->owned(), 16, [&](int s) {
    f(model.grid->brick(s), partial[static_cast<std::size_t>(omp_get_thread_num())]);
  });
  for (const P& mine : partial) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i].merge(mine[i]);
  }
}

/// Bodies [first, last).
struct BodyRange {
  std::size_t first = 0, last = 0;
};

Vec3<double> vector_of(const ExactSum* sum) { return {sum[0].value(), sum[1].value(), sum[2].value()}; }

Quantities quantities_of(const ExactSum* sum) {
  return {sum[mass].value(), sum[kinetic].value(), sum[internal].value(), vector_of(sum + momentum),
          vector_of(sum + angular_momentum)};
}

std::vector<double> inverse_densities(const Model& model) {
  std::vector<double> inverse;
  for (const Body& b : model.bodies) inverse.push_back(1 / b.model->reference_density());
  return inverse;
}

BodyTotals body_totals(const ExactSum* sum, const double* low, std::int64_t particles) {
  BodyTotals body;
  static_cast<Quantities&>(body) = quantities_of(sum);
  body.particles = particles;
  const double none = std::numeric_limits<double>::quiet_NaN();
  body.centre = body.lower = body.upper = {none, none, none};
  if (particles > 0) {
    const Vec3<double> first = vector_of(sum + moment);
    for (int a = 0; a < 3; ++a) {
      body.velocity[a] = body.momentum[a] / body.mass;
      body.centre[a] = first[a] / body.mass;
      body.lower[a] = low[lower + static_cast<std::size_t>(a)];
      body.upper[a] = -low[upper + static_cast<std::size_t>(a)];
    }
  }
  if (low[plastic_strain] < infinity) body.max_effective_plastic_strain = -low[plastic_strain];
  if (low[temperature] < infinity) body.max_temperature = -low[temperature];
  return body;
}

std::int64_t entry(const std::vector<std::int64_t>& values, std::size_t i) {
  return i < values.size() ? values[i] : 0;
}

}  // namespace

namespace {

/// Sums of some bodies over all ranks. Collective.
struct BodySums {
  std::vector<ExactSum> sum;
  std::vector<double> low;
  std::vector<std::int64_t> count;  ///< per body: particles, failed, eroded, left
};

BodySums sums_of_bodies(const Model& model, const std::vector<double>& inverse_density, BodyRange bodies,
                        Reductions& ranks) {
  std::vector<Partial> local(bodies.last - bodies.first);
  over_bricks(model, local, [&](const Brick& brick, std::vector<Partial>& to) {
    for (const ConstParticleBlock& b :
         blocks_of(model, brick, static_cast<int>(bodies.first), static_cast<int>(bodies.last))) {
      const auto body = static_cast<std::size_t>(b.body);
      add_block(*b.layout, b.data, b.used, inverse_density[body], to[body - bodies.first]);
    }
  });
  const Ledger& ledger = model.ledger;
  BodySums all;
  for (std::size_t b = bodies.first; b < bodies.last; ++b) {
    const Partial& mine = local[b - bodies.first];
    all.sum.insert(all.sum.end(), mine.sum.begin(), mine.sum.end());
    all.low.insert(all.low.end(), mine.low.begin(), mine.low.end());
    all.count.insert(all.count.end(),
                     {mine.particles, mine.failed, entry(ledger.body_eroded, b), entry(ledger.body_left, b)});
  }
  ranks.sum(std::span(all.sum));
  ranks.sum(std::span(all.count));
  ranks.minimum(all.low);
  return all;
}

/// The kinetic energy and angular momentum of a rigid body whose inertia is not that of its particles.
void take_rotation(const RigidState& state, ExactSum* sum) {
  sum[kinetic] = {};
  sum[kinetic].add(kinetic_energy(state));
  const Vec3<double> l = cross(state.centre, state.mass * state.velocity) + state.inertia * state.spin;
  for (int a = 0; a < 3; ++a) {
    sum[angular_momentum + static_cast<std::size_t>(a)] = {};
    sum[angular_momentum + static_cast<std::size_t>(a)].add(l[a]);
  }
}

bool has_own_rotation(const Body& body) { return body.inertia_given && body.rigid_state; }

}  // namespace

Totals compute_totals(const Model& model, Reductions& ranks) {
  // An exact sum takes half a kilobyte, each body has a dozen per thread: bodies are therefore processed in
  // groups of the same size on every rank.
  constexpr std::size_t at_once = 256;
  const std::size_t bodies = model.bodies.size();
  const std::vector<double> inverse_density = inverse_densities(model);
  Totals totals;
  std::array<ExactSum, sums> all;
  for (std::size_t first = 0; first < bodies; first += at_once) {
    const BodyRange range{first, std::min(first + at_once, bodies)};
    BodySums part = sums_of_bodies(model, inverse_density, range, ranks);
    for (std::size_t b = 0; b < range.last - range.first; ++b) {
      ExactSum* body_sum = &part.sum[sums * b];
      const Body& of = model.bodies[first + b];
      if (has_own_rotation(of)) take_rotation(*of.rigid_state, body_sum);
      const std::int64_t* c = &part.count[4 * b];
      BodyTotals body = body_totals(body_sum, &part.low[lows * b], c[0]);
      body.failed = c[1];
      body.eroded = c[2];
      body.left_grid = c[3];
      totals.particles += body.particles;
      totals.failed += body.failed;
      totals.bodies.push_back(body);
      for (std::size_t i = 0; i < sums; ++i) all[i] += body_sum[i];
    }
  }
  static_cast<Quantities&>(totals) = quantities_of(all.data());

  const Ledger& ledger = model.ledger;
  std::array booked{ledger.external_work,    ledger.removed_mass,       ledger.removed_kinetic,
                    ledger.removed_internal, ledger.contact.dissipated, ledger.contact.friction_heat(),
                    ledger.internal_lead};
  std::array<std::int64_t, 3> count{ledger.eroded, ledger.left_grid, ledger.velocity_limited};
  ranks.sum(std::span<ExactSum>(booked));
  ranks.sum(std::span<std::int64_t>(count));
  totals.external_work = booked[0].value();
  totals.removed_mass = booked[1].value();
  totals.removed_kinetic = booked[2].value();
  totals.removed_internal = booked[3].value();
  totals.dissipated_by_contact = booked[4].value();
  totals.friction_heat = booked[5].value();
  totals.internal_lead = booked[6].value();
  totals.eroded = count[0];
  totals.left_grid = count[1];
  totals.velocity_limited = count[2];
  return totals;
}

namespace {

struct EnergySums {
  ExactSum kinetic, internal;
  void merge(const EnergySums& other) {
    kinetic += other.kinetic;
    internal += other.internal;
  }
};

/// Of this rank's particles.
EnergySums energy_sums(const Model& model, const Reductions& ranks) {
  const std::vector<double> inverse_density = inverse_densities(model);
  std::vector<EnergySums> local(1);
  over_bricks(model, local, [&](const Brick& brick, std::vector<EnergySums>& to) {
    for (const ConstParticleBlock& b : blocks_of(model, brick)) {
      const BlockEnergies sum =
          energies_of(*b.layout, b.data, b.used, inverse_density[static_cast<std::size_t>(b.body)]);
      if (!has_own_rotation(model.bodies[static_cast<std::size_t>(b.body)])) to[0].kinetic.add(sum.kinetic);
      to[0].internal.add(sum.internal);
    }
  });
  for (const Body& body : model.bodies)
    if (has_own_rotation(body) && ranks.rank() == 0) local[0].kinetic.add(kinetic_energy(*body.rigid_state));
  return local[0];
}

}  // namespace

Energies compute_energies(const Model& model, Reductions& ranks) {
  const EnergySums local = energy_sums(model, ranks);
  std::array<ExactSum, 2> sum{local.kinetic, local.internal};
  ranks.sum(std::span<ExactSum>(sum));
  return {sum[0].value(), sum[1].value()};
}

Totals compute_energy_totals(const Model& model, Reductions& ranks) {
  const EnergySums local = energy_sums(model, ranks);
  const Ledger& ledger = model.ledger;
  std::array sum{local.kinetic,          local.internal,          ledger.external_work,
                 ledger.removed_kinetic, ledger.removed_internal, ledger.contact.dissipated,
                 ledger.internal_lead};
  ranks.sum(std::span<ExactSum>(sum));
  Totals totals;
  totals.kinetic = sum[0].value();
  totals.internal = sum[1].value();
  totals.external_work = sum[2].value();
  totals.removed_kinetic = sum[3].value();
  totals.removed_internal = sum[4].value();
  totals.dissipated_by_contact = sum[5].value();
  totals.internal_lead = sum[6].value();
  return totals;
}

EnergyBalance energy_balance(const Totals& totals, double initial_energy) {
  EnergyBalance balance;
  balance.total = totals.kinetic + totals.internal;
  const double accounted = balance.total - totals.internal_lead + totals.removed_kinetic +
                           totals.removed_internal + totals.dissipated_by_contact;
  const double scale =
      std::max({std::abs(initial_energy), std::abs(totals.external_work), std::abs(accounted)});
  if (!(scale > 0)) return balance;
  balance.scale = scale;
  balance.relative_drift = (accounted - totals.external_work - initial_energy) / scale;
  balance.initial_share = std::abs(initial_energy) / scale;
  return balance;
}

std::vector<ContactPairTotals> contact_pair_totals(const Model& model, Reductions& ranks) {
  if (!model.scene->contact.enable) return {};
  std::vector<ContactRecord::Pair> pairs = model.ledger.contact.pairs;
  pairs.resize(ContactPairs(component_count(*model.scene)).size());  // a rank without contact yet has none
  std::vector<ExactSum> sums;
  for (const ContactRecord::Pair& pair : pairs) {
    sums.insert(sums.end(), pair.impulse.begin(), pair.impulse.end());
    sums.push_back(pair.friction_heat);
  }
  ranks.sum(std::span(sums));
  std::vector<ContactPairTotals> totals(pairs.size());
  auto next = sums.begin();
  for (ContactPairTotals& pair : totals) {
    for (int a = 0; a < 3; ++a) pair.impulse[a] = (next++)->value();
    pair.friction_heat = (next++)->value();
  }
  return totals;
}

namespace {

/// Where particles belong to nodes, up to eight bricks have particles in the same cell, also of other ranks.
std::int64_t cells_of_several_bricks(const Model& model, Reductions& ranks) {
  const GridGeometry& geometry = model.grid->geometry();
  std::vector<std::int64_t> inside, border;  // numbers of cells; those that other ranks may have, too
  for (Slot s = 0; s < model.grid->owned(); ++s) {
    const Brick& brick = model.grid->brick(s);
    const bool at_border = std::ranges::any_of(
        brick.neighbour, [&](Slot n) { return n != no_slot && n >= model.grid->owned(); });
    for (const ConstParticleBlock& block : blocks_of(model, brick)) {
      for (const ConstParticle p : block) {
        const Vec3<double> x = p.vector(Column::position_x);
        std::int64_t cell = 0;
        for (int a = 2; a >= 0; --a)
          cell = geometry.cells[static_cast<std::size_t>(a)] * cell + geometry.cell_index(x[a], a);
        (at_border ? border : inside).push_back(cell);
      }
    }
  }
  const auto distinct = [](std::vector<std::int64_t>& cells) {
    std::ranges::sort(cells);
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  };
  distinct(inside);
  distinct(border);
  std::erase_if(inside, [&](std::int64_t cell) { return std::ranges::binary_search(border, cell); });
  std::string mine;
  for (const std::int64_t cell : border) mine += fmt::format("{} ", cell);
  border.clear();
  for (const std::string& of_rank : ranks.gather(mine)) {
    std::istringstream cells(of_rank);
    for (std::int64_t cell; cells >> cell;) border.push_back(cell);
  }
  distinct(border);
  auto count = static_cast<std::int64_t>(inside.size());
  ranks.sum(std::span(&count, 1));
  return count + static_cast<std::int64_t>(border.size());
}

}  // namespace

std::int64_t occupied_cells(const Model& model, Reductions& ranks) {
  const GridGeometry& geometry = model.grid->geometry();
  if (geometry.site == Site::node) return cells_of_several_bricks(model, ranks);
  std::int64_t cells = 0;
  const int bricks = model.grid->owned();
#pragma omp parallel for schedule(dynamic, 16) reduction(+ : cells)
  for (int s = 0; s < bricks; ++s) {
    std::uint64_t seen = 0;
    for (const ConstParticleBlock& block : blocks_of(model, model.grid->brick(s))) {
      for (const ConstParticle p : block) {
        const Vec3<double> x = p.vector(Column::position_x);
        int cell = 0;
        for (int a = 2; a >= 0; --a)
          cell = brick_cells * cell + static_cast<int>(geometry.cell_index(x[a], a) % brick_cells);
        seen |= std::uint64_t{1} << (cell & 63);
      }
    }
    cells += __builtin_popcountll(seen);
  }
  ranks.sum(std::span(&cells, 1));
  return cells;
}

}  // namespace mpm::core
