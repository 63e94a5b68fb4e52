#include "core/step/totals.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "core/communication/solo.hpp"

using namespace mpm::core;

namespace {

class Plain final : public ConstitutiveModel {
 public:
  const std::string& name() const override { return name_; }
  ColumnSet columns(const UpdateOptions&) const override { return {}; }
  double initial_sound_speed() const override { return 0; }
  double reference_density() const override { return 4; }
  void initialise(Batch&, const UpdateOptions&) const override {}
  void update(Batch&, const UpdateOptions&) const override {}

 private:
  std::string name_ = "plain";
};

/// Two bodies on 8^3 unit cells; the second carries plastic strain, temperature and failure.
Model two_bodies() {
  Model model;
  model.materials.push_back(std::make_unique<Plain>());
  GridGeometry geometry;
  geometry.cell = geometry.inverse_cell = {1, 1, 1};
  geometry.cells = {8, 8, 8};
  model.grid = std::make_unique<BrickGrid>(geometry);
  model.grid->reset({{0, 0, 0}, {1, 0, 0}, {1, 1, 1}}, {});
  for (int b = 0; b < 2; ++b) {
    Body& body = model.bodies.emplace_back();
    body.model = model.materials[0].get();
    ColumnSet columns = ColumnSet::mechanics();
    if (b == 1) columns.add({Column::effective_plastic_strain, Column::temperature, Column::failed});
    body.pool = std::make_shared<BlockPool>(ColumnLayout(columns));
  }
  return model;
}

struct P {
  int body;
  Vec3<double> x, v;
  double m, e;
  double epef = 0, temperature = 0, failed = 0;
};

void add(Model& model, const P& p) {
  BlockPool& pool = *model.bodies[static_cast<std::size_t>(p.body)].pool;
  const ColumnLayout& layout = pool.layout();
  std::vector<double> columns(static_cast<std::size_t>(layout.columns()));
  const auto set = [&](Column c, double value) {
    if (layout.has(c)) columns[static_cast<std::size_t>(layout.offset(c) / block_lanes)] = value;
  };
  for (int a = 0; a < 3; ++a) {
    set(next(Column::position_x, a), p.x[a]);
    set(next(Column::velocity_x, a), p.v[a]);
  }
  set(Column::mass, p.m);
  set(Column::internal_energy, p.e);
  set(Column::effective_plastic_strain, p.epef);
  set(Column::temperature, p.temperature);
  set(Column::failed, p.failed);
  Brick& brick = model.grid->brick(model.grid->find(model.grid->geometry().brick_at(p.x)));
  for (ParticleTile& c : brick.tiles) {
    if (c.body != p.body) continue;
    append(pool, c, columns.data());
    return;
  }
  brick.tiles.emplace_back().body = p.body;
  append(pool, brick.tiles.back(), columns.data());
}

}  // namespace

TEST_CASE("Totals add up what the particles are and do") {
  Model model = two_bodies();
  add(model, {0, {1, 2, 3}, {10, 0, 0}, 2, 8});
  add(model, {0, {5, 2, 3}, {0, 4, -2}, 6, 0});
  add(model, {1, {7, 7, 7}, {1, 1, 1}, 1, -4, 0.5, 400, 1});
  add(model, {1, {6, 7, 7}, {1, 1, 1}, 1, 0, 0.25, 300, 0});
  model.ledger.body_eroded = {0, 9};
  model.ledger.eroded = 9;
  model.ledger.external_work.add(3);
  SoloCommunication solo;
  const Totals t = compute_totals(model, solo);
  REQUIRE(t.bodies.size() == 2);
  const BodyTotals& a = t.bodies[0];
  CHECK(a.particles == 2);
  CHECK(a.mass == 8);
  CHECK(a.kinetic == 0.5 * 2 * 100 + 0.5 * 6 * 20);
  CHECK(a.internal == 8 * 2 / 4.0);
  CHECK(a.momentum == Vec3<double>{20, 24, -12});
  // x cross m v: (1,2,3) x (20,0,0) + (5,2,3) x (0,24,-12)
  CHECK(a.angular_momentum == Vec3<double>{0 - 24 - 72, 60 + 60, -40 + 120});
  CHECK(a.velocity == Vec3<double>{2.5, 3, -1.5});
  CHECK(a.centre == Vec3<double>{4, 2, 3});
  CHECK(a.lower == Vec3<double>{1, 2, 3});
  CHECK(a.upper == Vec3<double>{5, 2, 3});
  CHECK(a.max_temperature == 0);
  const BodyTotals& b = t.bodies[1];
  CHECK(b.failed == 1);
  CHECK(b.eroded == 9);
  CHECK(b.max_effective_plastic_strain == 0.5);
  CHECK(b.max_temperature == 400);
  CHECK(t.particles == 4);
  CHECK(t.kinetic == a.kinetic + b.kinetic);
  CHECK(t.momentum == a.momentum + b.momentum);
  CHECK(t.external_work == 3);
  const Energies e = compute_energies(model, solo);
  CHECK(e.kinetic == t.kinetic);
  CHECK(e.internal == t.internal);
  model.ledger.removed_kinetic.add(0.1);
  model.ledger.removed_internal.add(0.3);
  const EnergyBalance every = energy_balance(compute_energy_totals(model, solo), 7);
  const EnergyBalance reported = energy_balance(compute_totals(model, solo), 7);
  CHECK(every.total == reported.total);
  CHECK(every.relative_drift == reported.relative_drift);
  CHECK(every.relative_drift != 0);
  CHECK(occupied_cells(model, solo) == 4);
}

TEST_CASE("Totals do not lose small parts beside large ones") {
  // Opposite momenta of 1e17 leave a rest of 1, in whatever order of bricks: a plain sum would lose it.
  Model model = two_bodies();
  add(model, {0, {1, 1, 1}, {1e17, 0, 0}, 1, 0});
  add(model, {0, {5, 1, 1}, {1, 0, 0}, 1, 0});
  add(model, {0, {5, 5, 5}, {-1e17, 0, 0}, 1, 0});
  SoloCommunication solo;
  CHECK(compute_totals(model, solo).momentum.x == 1);
}

TEST_CASE("The totals of very many bodies, which are added up some at a time, are theirs") {
  constexpr int many = 1300;  // more than two groups on one thread
  Model model = two_bodies();
  model.bodies.clear();
  BlockPools pools;
  for (int b = 0; b < many; ++b) {
    Body& body = model.bodies.emplace_back();
    body.model = model.materials[0].get();
    body.pool = pools.of(ColumnSet::mechanics());
  }
  CHECK(pools_of(model).size() == 1);
  double mass = 0;
  for (int b = 0; b < many; ++b) {
    const double m = 1 + b % 7;
    add(model, {b, {b % 8 < 4 ? 1.0 : 5.0, 1 + 0.0001 * b, 3}, {0, 1.0 * b, 0}, m, 4});
    mass += m;
  }
  model.ledger.body_left.assign(many, 0);
  model.ledger.body_left[many - 1] = 3;
  model.ledger.left_grid = 3;
  SoloCommunication solo;
  const Totals t = compute_totals(model, solo);
  REQUIRE(t.bodies.size() == many);
  CHECK(t.particles == many);
  CHECK(t.mass == mass);
  CHECK(t.left_grid == 3);
  int wrong = 0;
  for (int b = 0; b < many; ++b) {
    const BodyTotals& body = t.bodies[static_cast<std::size_t>(b)];
    const double m = 1 + b % 7;
    wrong += body.particles != 1 || body.mass != m || body.momentum.y != m * b ||
             body.left_grid != (b == many - 1 ? 3 : 0);
  }
  CHECK(wrong == 0);
}

TEST_CASE("A body without particles has mass 0 and no place") {
  Model model = two_bodies();
  SoloCommunication solo;
  const Totals t = compute_totals(model, solo);
  CHECK(t.bodies[0].mass == 0);
  CHECK(t.bodies[0].velocity == Vec3<double>{0, 0, 0});
  CHECK(std::isnan(t.bodies[0].centre.x));
  CHECK(std::isnan(t.bodies[1].lower.z));
  CHECK(t.bodies[1].max_temperature == 0);
}

TEST_CASE("The energy balance counts what came in and what went out") {
  Totals t;
  t.kinetic = 60;
  t.internal = 30;
  t.removed_kinetic = 5;
  t.removed_internal = 5;
  t.external_work = 20;
  const EnergyBalance kept = energy_balance(t, 80);
  CHECK(kept.total == 90);
  CHECK(kept.relative_drift == 0);
  CHECK(energy_balance(t, 79).relative_drift == Approx(0.01).epsilon(1e-14));
  t.internal_lead = 8;
  CHECK(energy_balance(t, 72).relative_drift == 0);
  CHECK(energy_balance(Totals{}, 0).relative_drift == 0);
}
