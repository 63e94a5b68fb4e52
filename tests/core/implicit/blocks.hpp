#pragma once
// Blocks of particles in a grid, soft or rigid, and their nodes as unknowns, for the tests of faces.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "core/communication/solo.hpp"
#include "core/implicit/brick_fields.hpp"
#include "core/implicit/node_unknowns.hpp"
#include "core/particle_range.hpp"
#include "core/setup/particle_creation.hpp"
#include "core/step/passes.hpp"
#include "tests/core/discretise/support.hpp"

namespace mpm::core::testing {

/// A law without a stress, as tests of faces need none.
class Stressless final : public ConstitutiveModel {
 public:
  static constexpr double sound_speed = 3;
  explicit Stressless(bool rigid) : rigid_(rigid) {}
  const std::string& name() const override { return name_; }
  ColumnSet columns(const UpdateOptions&) const override { return {}; }
  double initial_sound_speed() const override { return rigid_ ? 0 : sound_speed; }
  double reference_density() const override { return density; }
  bool rigid() const override { return rigid_; }
  void initialise(Batch&, const UpdateOptions&) const override {}
  void update(Batch&, const UpdateOptions&) const override {}

 private:
  std::string name_ = "stressless";
  bool rigid_;
};

/// Of three bricks of cells of edge 1 along each axis, from the origin on.
inline GridGeometry three_bricks() {
  GridGeometry g;
  g.cell = g.inverse_cell = {1, 1, 1};
  g.cells = {12, 12, 12};
  return g;
}

/// Gives the model the active bodies of a scene and their particles, all on one rank of this grid.
inline void make_bodies(Model& model, const Scene& scene, GridGeometry g, SoloCommunication& solo) {
  model.scene = std::make_shared<Scene>(scene);
  g.site = site_of(scene);
  model.grid = std::make_unique<BrickGrid>(g, node_block_of(scene),
                                           node_arrays_of(scene, scene.solution.scheme, false));
  std::vector<std::size_t> all;
  for (const BodyInput* input : active_bodies(scene)) {
    all.push_back(model.bodies.size());
    Body& made = model.bodies.emplace_back();
    made.name = input->name;
    made.pool = std::make_shared<BlockPool>(ColumnLayout(ColumnSet::mechanics()));
  }
  const std::vector<BodySeeds> seeds = seeds_of(model, all);
  const SeedCount count = count_seeds(g, seeds, solo.reductions);
  REQUIRE(count.outside == 0);
  solo.bricks.partition(*model.grid, count.in_bricks(), {});
  create_particles(model, seeds, solo);
}

struct Block {
  bool rigid;
  BlockGeometry geometry;
};

/// Of bodies numbered in the order of the blocks, with all particles on one rank.
struct Blocks {
  SoloCommunication solo;
  Stressless soft{false}, rigid{true};
  Model model;

  explicit Blocks(std::span<const Block> blocks, ShapeFunction shape = ShapeFunction::linear,
                  const GridGeometry& g = three_bricks()) {
    Scene scene;
    scene.grid.shape = shape;
    scene.components.resize(1);
    for (const Block& block : blocks) scene.components[0].bodies.push_back(body(block.geometry));
    make_bodies(model, scene, g, solo);
    for (std::size_t b = 0; b < blocks.size(); ++b) model.bodies[b].model = blocks[b].rigid ? &rigid : &soft;
  }
};

/// Blocks, and all nodes of their bricks inside the grid as unknowns.
struct NodesOfBlocks : Blocks {
  BrickFields fields;
  NodeUnknowns unknowns;

  explicit NodesOfBlocks(std::span<const Block> blocks, ShapeFunction shape = ShapeFunction::linear,
                         const GridGeometry& g = three_bricks())
      : Blocks(blocks, shape, g), unknowns(model, solo, fields) {
    fields.find(*model.grid);
  }
  void number() {
    unknowns.exchange(mapped::implicit_start);
    unknowns.number();
    unknowns.hold_walls();
  }
};

}  // namespace mpm::core::testing
