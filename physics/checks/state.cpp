// Checks that a law's state is in the declared columns only.

#include <bit>
#include <cstdint>
#include <cstring>
#include <random>

#include "physics/checks/checker.hpp"

namespace mpm::physics::checks {

using core::Column;
using core::ColumnSet;
using core::Mat3;

namespace {

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

std::string named(Column c) { return "column " + std::string(core::name_of(c)); }

template <class F>
void for_each_column(F f) {
  for (int i = 0; i < core::column_count; ++i) f(static_cast<Column>(i));
}

}  // namespace

Failures instances_agree(const LawSample& sample, const Registry& registry) {
  Checker c(sample, registry);
  PointDriver::Options options = c.with_viscosity();
  options.extra_columns = {Column::yield_stress};
  PointDriver vector(*c.material, options),
      scalar(*c.material, options, [&](core::Batch&batch, const core::UpdateOptions&update) {
        c.material->update_scalars(batch, update);
      });
  const RandomPath path = c.path(1);
  const double scale = walk(vector, path, 200);
  walk(scalar, path, 200);
  // Contraction and the library's exp and log differ: a few roundings per step, relative to the largest
  // stress and to the moduli multiplied by differences of nearly equal volumes.
  c.at_most(norm(vector.stress() - scalar.stress()), 1e-12 * scale + 1e-13 * c.stiffness(),
            "difference of the stresses");
  c.at_most(std::abs(vector.energy() - scalar.energy()), 1e-12 * std::max(scale, std::abs(scalar.energy())),
            "difference of the energies");
  for (const Column column : {Column::effective_plastic_strain, Column::temperature, Column::damage}) {
    if (vector.has(column))
      c.near(vector.value(column), scalar.value(column), 1e-11, 1e-14, "difference in " + named(column));
  }
  return c.failures;
}

Failures rest_stays(const LawSample& sample, const Registry& registry) {
  Checker c(sample, registry);
  PointDriver point(*c.material, c.with_viscosity());
  const double p = point.value(Column::pressure), e = point.energy();
  for (int i = 0; i < 10; ++i) point.step({}, 5e-3 * sample.duration);
  c.at_most(norm(point.deviator()), 0, "deviatoric stress");
  // 1 + mu comes from a division, so mu at rest is zero to round-off.
  c.at_most(std::abs(point.value(Column::pressure) - p), 4e-16 * c.stiffness(), "change of the pressure");
  c.at_most(std::abs(point.energy() - e), 0, "change of the energy");
  c.require(point.events().not_finite == 0, "the state is not finite");
  return c.failures;
}

/// Emulates a restart: a new material, the particles' columns and the time.
Failures restarts(const LawSample& sample, const Registry& registry) {
  constexpr int steps = 100;
  Checker c(sample, registry);
  const RandomPath path = c.path(2);
  const double dt = sample.duration / steps;
  const auto second = c.make();
  PointDriver through(*c.material, c.with_viscosity()), after(*second, c.with_viscosity());
  for (int i = 0; i < steps; ++i) {
    if (i == steps / 2) after.restore(through.save());
    const Mat3<double> l = path.gradient((i + 0.5) * dt);
    through.step(l, dt);
    if (i >= steps / 2) after.step(l, dt);
  }
  const auto expected = through.save(), found = after.save();
  c.require(
      std::memcmp(expected.block.data(), found.block.data(), expected.block.size() * sizeof(double)) == 0,
      "the columns differ after a restart: all history of the law must be in its `state`");
  c.require(after.critical_speed() == through.critical_speed(), "the wave speed differs after a restart");
  return c.failures;
}

namespace {

std::vector<core::DetonationItem> scaled(std::vector<core::DetonationItem> items, double per_length,
                                         double per_time) {
  for (core::DetonationItem& item : items) {
    item.time *= per_time;
    item.position = per_length * item.position;
    item.location *= per_length;
    for (std::array<double, 2>* corner : {&item.lower, &item.upper})
      for (double& x : *corner) x *= per_length;
  }
  return items;
}

}  // namespace

/// SI and mm-g-ms, for a sample in SI. Reveals absolute tolerances inside a law.
Failures units_agree(const LawSample& sample, const Registry& registry) {
  Checker c(sample, registry);
  const double length = 1e3, mass = 1e3, time = 1e3, velocity = length / time,
               stress = mass / (length * time * time);
  const auto other = make_material(in_units(sample.input, registry.catalogue(), length, mass, time),
                                   scaled(sample.detonations, length, time), registry);
  const RandomPath path = c.path(2), converted_path(2, sample.strain, sample.duration * time);
  PointDriver a(*c.material, c.with_viscosity()), b(*other, {.cell_size = sample.cell_size * length});
  const double scale = walk(a, path, 100);
  walk(b, converted_path, 100);
  // Only the rounding of the conversion differs.
  c.at_most(norm(a.stress() - (1 / stress) * b.stress()), 1e-11 * scale + 1e-13 * c.stiffness(),
            "difference of the stresses");
  c.at_most(std::abs(a.energy() - b.energy() / stress), 1e-11 * std::max(scale, std::abs(a.energy())),
            "difference of the energies");
  c.near(a.critical_speed(), b.critical_speed() / velocity, 1e-11, 0, "difference of the wave speeds");
  for (const Column column :
       {Column::effective_plastic_strain, Column::temperature, Column::damage, Column::failed}) {
    if (a.has(column))
      c.near(a.value(column), b.value(column), 1e-10, 1e-14, "difference in " + named(column));
  }
  return c.failures;
}

namespace {

/// A batch of particles, each with its own state and strain.
struct Crowd {
  Crowd(const Checker& c, int blocks) {
    ColumnSet set = ColumnSet::mechanics();
    set.add(c.material->columns({}));
    layout = core::ColumnLayout(set);
    memory.assign(static_cast<std::size_t>(blocks * layout.block_doubles()), 0.0);
    batch.blocks = blocks;
    batch.particles = core::block_lanes * blocks;
    batch.dt = 5e-3 * c.sample.duration, batch.cell_size = c.sample.cell_size;
    connect();
    for (int i = 0; i < batch.particles; ++i) {
      at(Column::mass, i) = c.sample.input.reference_density;
      at(Column::volume, i) = 1;
    }
    c.material->initialise(batch, {});
  }
  /// Makes the batch point into this object; required after a move.
  void connect() {
    batch.layout = &layout;
    for (int b = 0; b < batch.blocks; ++b) batch.block[b] = memory.data() + b * layout.block_doubles();
  }
  double& at(Column c, int place) {
    return batch.column(c, place / core::block_lanes)[place % core::block_lanes];
  }
  core::ColumnLayout layout;
  std::vector<double> memory;
  core::Batch batch{};
};

/// Strain of the step of a particle.
double strain_of(int particle, int component, int step) {
  std::mt19937 random(static_cast<unsigned>(1000 * particle + 10 * component + step));
  return std::uniform_real_distribution<double>(-3e-3, 3e-3)(random);
}

}  // namespace

Failures neighbours_do_not_matter(const LawSample& sample, const Registry& registry) {
  constexpr int particles = core::batch_particles, each = 7, lane_alone = 3;
  Checker c(sample, registry);
  Crowd crowd(c, core::batch_blocks);
  std::vector<Crowd> alone;
  for (int i = 0; i < particles; i += each) alone.emplace_back(c, 1);
  for (Crowd& one : alone) one.connect();
  for (int step = 0; step < 10; ++step) {
    for (int k = 0; k < 9; ++k) {
      for (int i = 0; i < particles; ++i) crowd.batch.gradient[k][i] = strain_of(i, k, step) / crowd.batch.dt;
    }
    c.material->update(crowd.batch, {});
    for (std::size_t n = 0; n < alone.size(); ++n) {
      // The single particle is in another lane; the others do not move.
      core::Batch& batch = alone[n].batch;
      for (int k = 0; k < 9; ++k) {
        std::fill_n(batch.gradient[k], core::block_lanes, 0.0);
        batch.gradient[k][lane_alone] = strain_of(static_cast<int>(each * n), k, step) / batch.dt;
      }
      c.material->update(batch, {});
    }
  }
  for_each_column([&](Column column) {
    if (!crowd.layout.has(column)) return;
    int different = 0;
    for (std::size_t n = 0; n < alone.size(); ++n)
      different +=
          bits(crowd.at(column, static_cast<int>(each * n))) != bits(alone[n].at(column, lane_alone));
    c.at_most(different, 0, "particles whose " + named(column) + " differs");
  });
  return c.failures;
}

namespace {

/// Output columns, written if the layout has them, without being state of the law.
bool is_output(Column c) { return c == Column::yield_stress || c == Column::sound_speed; }

ColumnSet every_column_but_strains() {
  ColumnSet set;
  for_each_column([&](Column c) {
    // The presence of these columns in the layout requests accumulation, heating or failure.
    const bool requests = c >= Column::strain_xx && c <= Column::strain_xz;
    if (!requests && c != Column::failed && c != Column::temperature) set.add(c);
  });
  return set;
}

constexpr int column_steps = 60;

/// State after the path; the column `changed` is set to `value` before the second half if `set` is true.
std::vector<double> state_after(const Checker& c, const ColumnSet& watched, Column changed, double value,
                                bool set) {
  PointDriver point(*c.material, c.with_viscosity());
  walk(point, c.path(9), column_steps);
  if (set) point.set(changed, value);
  walk(point, c.path(9), column_steps);
  std::vector<double> state;
  for_each_column([&](Column column) {
    if (watched.has(column) && column != changed) state.push_back(point.value(column));
  });
  return state;
}

}  // namespace

/// In a layout with all columns the undeclared ones hold a pattern; the pattern must survive, and the results
/// must equal those of the minimal layout.
Failures columns_suffice(const LawSample& sample, const Registry& registry) {
  Checker c(sample, registry);
  const double pattern = std::nan("0x123456");
  ColumnSet declared = ColumnSet::mechanics();
  declared.add(c.material->columns({}));
  PointDriver::Options options = c.with_viscosity();
  PointDriver lean(*c.material, options);
  options.extra_columns = every_column_but_strains();
  PointDriver full(*c.material, options);
  for_each_column([&](Column column) {
    if (full.has(column) && !declared.has(column)) full.set(column, pattern);
  });
  walk(lean, c.path(9), column_steps);
  walk(full, c.path(9), column_steps);
  for_each_column([&](Column column) {
    if (declared.has(column))
      c.require(bits(full.value(column)) == bits(lean.value(column)),
                named(column) + " depends on columns that are not declared");
    else if (full.has(column) && !is_output(column))
      c.require(bits(full.value(column)) == bits(pattern), named(column) + " is written, not declared");
  });
  return c.failures;
}

Failures columns_are_used(const LawSample& sample, const Registry& registry) {
  Checker c(sample, registry);
  const ColumnSet declared = c.material->columns({});
  ColumnSet watched = ColumnSet::mechanics();
  watched.add(declared);
  for_each_column([&](Column column) {
    if (!declared.has(column)) return;
    PointDriver start(*c.material, {}), end(*c.material, {}), burst(*c.material, {});
    walk(end, c.path(9), column_steps);
    const double dt = sample.duration / column_steps, rate = 0.5 / sample.duration;
    for (int i = 0; i < column_steps; ++i) burst.step({rate, 0, 0, 0, rate, 0, 0, 0, rate}, dt);
    // Written on the path, where the material is torn apart, or at the start, where all columns were zero
    // before.
    const double first = start.value(column);
    const bool written =
        first != 0 || bits(first) != bits(end.value(column)) || bits(first) != bits(burst.value(column));
    const double other = column == Column::temperature ? 600 : 0.75;
    c.require(written || state_after(c, watched, column, other, true) !=
                             state_after(c, watched, column, other, false),
              named(column) + " is declared, and neither read nor written");
  });
  return c.failures;
}

}  // namespace mpm::physics::checks
