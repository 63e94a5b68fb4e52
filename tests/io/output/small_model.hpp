// A model made by hand for the tests of files: three bodies of two materials on a grid of 12^3 unit cells,
// every column filled with numbers of its own. The same particles in the same order on any ranks.
#pragma once

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

#include "core/communication/solo.hpp"
#include "core/model.hpp"
#include "core/particles/tile_order.hpp"

namespace mpm::tests {

class SmallMaterial final : public core::ConstitutiveModel {
 public:
  SmallMaterial(std::string name, double density, core::ColumnSet columns)
      : name_(std::move(name)), density_(density), columns_(columns) {}
  const std::string& name() const override { return name_; }
  core::ColumnSet columns(const core::UpdateOptions&) const override { return columns_; }
  double initial_sound_speed() const override { return 1; }
  double reference_density() const override { return density_; }
  void initialise(core::Batch&, const core::UpdateOptions&) const override {}
  void update(core::Batch&, const core::UpdateOptions&) const override {}

 private:
  std::string name_;
  double density_;
  core::ColumnSet columns_;
};

struct SmallSetup {
  int particles = 300;             ///< of each of the first two bodies; the third has one
  core::ColumnSet shown;           ///< more columns for every body
  bool only_one_material = false;  ///< the bodies then carry nothing but the mechanics
  std::int64_t cells = 12;
};

/// Numbers in [0, 1) that depend on nothing but `n`.
inline double number(std::uint64_t n) {
  std::uint64_t h = (n + 1) * 0x9e3779b97f4a7c15u;
  h = (h ^ (h >> 31)) * 0xbf58476d1ce4e5b9u;
  return static_cast<double>((h ^ (h >> 29)) >> 11) * 0x1p-53;
}

inline std::shared_ptr<core::Scene> small_scene() {
  auto scene = std::make_shared<core::Scene>();
  scene->header = {"small", "A <small> model -- of & for tests", "", "ms", "mm", "g"};
  scene->provenance = {"folder/small.xmp", "small", "0123456789abcdef"};
  scene->grid.source = {"folder/small.xmp", 7};
  scene->materials.resize(2);
  scene->materials[0].name = "copper";
  scene->materials[1].name = "wax";
  scene->components.resize(2);
  scene->components[0].name = "flyer";
  scene->components[1].name = "target";
  scene->components[0].bodies.resize(1);
  scene->components[0].bodies[0].name = "bar";
  scene->components[1].bodies.resize(2);
  scene->components[1].bodies[0].name = "wall <&> floor";
  scene->components[1].bodies[1].name = "dust";
  for (auto& component : scene->components) {
    for (auto& body : component.bodies) body.source = {"folder/small.xmp", 5};
  }
  scene->solution.end_time = 2;
  return scene;
}

/// Bodies and an empty grid.
inline core::Model prepared_model(std::shared_ptr<const core::Scene> scene, const SmallSetup& setup = {}) {
  core::Model model;
  const core::ColumnSet copper{core::Column::effective_plastic_strain, core::Column::temperature,
                               core::Column::failed};
  model.materials.push_back(std::make_unique<SmallMaterial>(
      "copper", 8.93e-3, setup.only_one_material ? core::ColumnSet() : copper));
  model.materials.push_back(std::make_unique<SmallMaterial>("wax", 1e-3, core::ColumnSet()));
  core::GridGeometry geometry;
  geometry.cell = geometry.inverse_cell = {1, 1, 1};
  geometry.cells = {setup.cells, setup.cells, setup.cells};
  model.grid = std::make_unique<core::BrickGrid>(geometry);
  for (std::size_t c = 0; c < scene->components.size(); ++c) {
    for (const core::BodyInput& input : scene->components[c].bodies) {
      if (input.deactivated || input.for_bool) continue;
      core::Body& body = model.bodies.emplace_back();
      body.name = input.name;
      body.component = static_cast<int>(c);
      body.material = input.name == "wall <&> floor" ? 1 : 0;
      body.model = model.materials[static_cast<std::size_t>(body.material)].get();
      body.no_output = input.no_output;
      core::ColumnSet columns = core::ColumnSet::mechanics();
      columns.add(body.model->columns({}));
      columns.add(setup.shown);
      body.pool = std::make_shared<core::BlockPool>(core::ColumnLayout(columns));
    }
  }
  model.ledger.body_eroded.resize(model.bodies.size());
  model.ledger.body_left.resize(model.bodies.size());
  model.scene = std::move(scene);
  return model;
}

/// The columns of one particle.
inline std::vector<double> small_particle(const core::ColumnLayout& layout, std::uint64_t identity) {
  std::vector<double> columns;
  for (int i = 0; i < core::column_count; ++i) {
    const auto c = static_cast<core::Column>(i);
    if (!layout.has(c)) continue;
    const double r = number(64 * identity + static_cast<std::uint64_t>(i));
    if (c <= core::Column::position_z) {
      columns.push_back(12 * r * (0.5 + 0.5 * static_cast<double>(identity % 2)));
    } else if (c == core::Column::mass || c == core::Column::volume) {
      columns.push_back(0.5 + r);
    } else if (c == core::Column::identity) {
      columns.push_back(static_cast<double>(identity));
    } else if (c == core::Column::failed) {
      columns.push_back(r < 0.25 ? 1 : 0);
    } else {
      columns.push_back(200 * (r - 0.5));
    }
  }
  return columns;
}

/// Deal the particles out. Collective.
inline void fill(core::Model& model, core::Communication& exchange, const SmallSetup& setup = {}) {
  struct Particle {
    std::size_t body;
    core::BrickCoord brick;
    std::vector<double> columns;
  };
  std::vector<Particle> particles;
  std::vector<core::BrickCount> counts;
  std::uint64_t identity = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const int n = b < 2 ? setup.particles : 1;
    for (int i = 0; i < n; ++i) {
      auto columns = small_particle(model.bodies[b].pool->layout(), identity++);
      const core::BrickCoord brick = model.grid->geometry().brick_at({columns[0], columns[1], columns[2]});
      if (exchange.reductions.rank() == 0) counts.push_back({brick, 1});
      particles.push_back({b, brick, std::move(columns)});
    }
  }
  exchange.bricks.partition(*model.grid, counts, model.scene->decomposition);
  for (const Particle& p : particles) {
    const core::Slot s = model.grid->find(p.brick);
    if (s == core::no_slot || s >= model.grid->owned()) continue;
    core::append(model, model.grid->brick(s), static_cast<int>(p.body), p.columns.data());
  }
  model.clock = {.step = 120,
                 .time = 0.25,
                 .dt = 1e-3,
                 .lag = 0.5e-3,
                 .first_lag = 0.625e-3,
                 .critical_dt = 1.25e-3,
                 .first_critical_dt = 1.5e-3,
                 .looks = {.scale = 2e6, .last = 1e-3, .early = -2e-3}};
  model.initial_energy = 1e6;
  model.next_identity = identity;
  // Every rank has something in its ledger; their sum is the same on any number of ranks.
  if (exchange.reductions.rank() == 0) {
    model.ledger.external_work.add(0.1);
    model.ledger.removed_mass.add(1e-30);
    model.ledger.left_grid = 3;
    model.ledger.body_left[0] = 3;
  }
  if (exchange.reductions.rank() == exchange.reductions.size() - 1) {
    model.ledger.external_work.add(1e20);
    model.ledger.eroded = 5;
    model.ledger.body_eroded[1] = 5;
    model.ledger.events.failed = 7;
  }
}

inline core::Model small_model(core::Communication& exchange, const SmallSetup& setup = {}) {
  core::Model model = prepared_model(small_scene(), setup);
  fill(model, exchange, setup);
  return model;
}

/// A folder of its own for a test case, empty at first and gone at its end. On one rank.
class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("mpm_" + name + "_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string path() const { return path_.string(); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace mpm::tests
