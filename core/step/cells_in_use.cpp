#include "core/step/cells_in_use.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "core/shape/cells_of_particles.hpp"
#include "core/shape/list.hpp"
#include "core/step/prefetch.hpp"
#include "core/threads.hpp"

namespace mpm::core {

namespace {

constexpr NodeFields node_fields = mapped::cells_in_use;

double largest_density(const std::vector<Body>& bodies) {
  double largest = 0;
  for (const Body& body : bodies) largest = std::max(largest, body.model->reference_density());
  return largest;
}

double least_density(const std::vector<Body>& bodies) {
  double least = std::numeric_limits<double>::infinity();
  for (const Body& body : bodies) least = std::min(least, body.model->reference_density());
  return least;
}

/// Whether particles that share nodes may differ much in density, in explicit steps.
bool may_be_much_lighter(const Model& model) {
  const Scene& scene = *model.scene;
  if (scene.solution.integration != Integration::explicit_dynamics) return false;
  const bool by_component = scene.contact.enable && !has_failed_component(scene);
  const auto differ = [&](const Body& a, const Body& b) {
    return (!by_component || a.component == b.component) &&
           a.model->reference_density() > much_lighter * b.model->reference_density();
  };
  return std::ranges::any_of(model.bodies, [&](const Body& a) {
    return std::ranges::any_of(model.bodies, [&](const Body& b) { return differ(a, b); });
  });
}

/// But for the zeros.
bool all_alike(const CellWeightsAround& weights) {
  double first = 0;
  for (const auto& row : weights.row) {
    for (const double weight : row) {
      if (first == 0) first = weight;
      if (weight != 0 && weight != first) return false;
    }
  }
  return true;
}

/// f(number of its bit, node of the brick's node block) for each cell.
template <class F>
void for_each_cell_of(const NodeBlockShape& shape, F f) {
  for (int k = 0; k < brick_cells; ++k) {
    for (int j = 0; j < brick_cells; ++j) {
      for (int i = 0; i < brick_cells; ++i)
        f(static_cast<std::size_t>(i + brick_cells * (j + brick_cells * k)), shape.index(i, j, k));
    }
  }
}

/// f(tile, its place in the brick) for the tiles of a component but those of the bodies `without`.
template <class F>
void for_each_tile(const Brick& brick, std::int32_t component, std::span<const int> without, F f) {
  for (std::size_t c = 0; c < brick.tiles.size(); ++c) {
    const ParticleTile& tile = brick.tiles[c];
    if (component != all_components && tile.component != component) continue;
    if (std::ranges::find(without, tile.body) == without.end()) f(tile, c);
  }
}

/// Adds the mirror images beyond the constrained faces of the grid. One axis after the other, so that those
/// beyond edges and corners follow. `weights`: those of `around`, if it has any.
void add_mirror_images(const GridGeometry& geometry, BrickCoord brick, CellsAround& around,
                       CellWeightsAround* weights) {
  const int first[3] = {brick_cells * brick.x, brick_cells * brick.y, brick_cells * brick.z};
  const auto copy_layer = [&](int axis, int from, int to) {
    int c[3];
    int &u = c[(axis + 1) % 3], &v = c[(axis + 2) % 3];
    for (u = -1; u <= brick_cells; ++u) {
      for (v = -1; v <= brick_cells; ++v) {
        c[axis] = from;
        if (!around.has(c[0], c[1], c[2])) continue;
        const double weight = around.weight(c[0], c[1], c[2]);
        c[axis] = to;
        around.add(c[0], c[1], c[2]);
        if (weights != nullptr) weights->row[CellsAround::index(c[1], c[2])][c[0] + 1] = weight;
      }
    }
  };
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const std::int64_t last = geometry.cells[a] - first[axis];  // the upper wall's node
    if (first[axis] == 0 && is_constrained(geometry.boundary[2 * a])) copy_layer(axis, 0, -1);
    if (last <= brick_cells && is_constrained(geometry.boundary[2 * a + 1]))
      copy_layer(axis, static_cast<int>(last) - 1, static_cast<int>(last));
  }
}

}  // namespace

std::uint64_t find_cells(const Model& model, Slot s, std::int32_t component, std::span<const int> without) {
  const BrickGrid& grid = *model.grid;
  const Brick& brick = grid.brick(s);
  const BrickFrame frame(grid.geometry(), brick.coord);
  constexpr int columns = static_cast<int>(Column::position_x) + 3;
  CellsOfParticles found;
  for_each_tile(brick, component, without, [&](const ParticleTile& tile, std::size_t c) {
    const BlockPool& pool = *model.bodies[static_cast<std::size_t>(tile.body)].pool;
    const BlockPrefetch prefetch(model, s, c);
    for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
      prefetch.request<Linear>(b, pool.layout(), columns);
      found.add(frame, pool.layout(), pool.block(tile.blocks[b]), (1u << tile.used_lanes(b)) - 1);
    }
  });
  return found.cells();
}

CellsInUse::CellsInUse(Model& model, NodeHalo& halo, CellUse use, std::vector<int> without)
    : model_(model),
      halo_(halo),
      without_(std::move(without)),
      use_(use),
      weighs_(use == CellUse::lighter ||
              std::ranges::any_of(
                  model.bodies, [&](const Body& body) { return body.material != model.bodies[0].material; })),
      largest_weight_(use == CellUse::lighter ? std::numeric_limits<double>::infinity()
                                              : largest_density(model.bodies) / 10),
      // USL's remedy for light nodes at free surfaces (core/step/node_update.hpp) is one for the lightest
      // material.
      empty_density_(model.scene->solution.scheme == Scheme::usl ? least_density(model.bodies) : 0) {}

/// f(number of its bit, density) for the cells of the particles. A particle's density is the least of its
/// material's density of reference, 4 m/V and the largest weight. So solids always have the same, materials
/// weigh alike whose densities differ up to tenfold, and gases weigh less once they have expanded much.
template <class F>
void CellsInUse::for_each_density(Slot s, std::int32_t component, F f) const {
  using Block = Lanes<block_lanes>;
  constexpr double least = std::numeric_limits<double>::min();
  const Brick& brick = model_.grid->brick(s);
  const BrickFrame frame(model_.grid->geometry(), brick.coord);
  for_each_tile(brick, component, without_, [&](const ParticleTile& tile, std::size_t c) {
    const Body& body = model_.bodies[static_cast<std::size_t>(tile.body)];
    const ColumnLayout& layout = body.pool->layout();
    const double most = std::max(std::min(body.model->reference_density(), largest_weight_), least);
    const BlockPrefetch prefetch(model_, s, c);
    CellsOfParticles found;  // of blocks without thin particles
    for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
      prefetch.request<Linear>(b, layout, static_cast<int>(Column::volume) + 1);
      const double* block = body.pool->block(tile.blocks[b]);
      const int used = tile.used_lanes(b);
      const double *x = block + layout.offset(Column::position_x),
                   *mass = block + layout.offset(Column::mass),
                   *volume = block + layout.offset(Column::volume);
      if (all(Block(4.0) * load<Block>(mass) >= Block(most) * load<Block>(volume))) {
        found.add(frame, layout, block, (1u << used) - 1);
        continue;
      }
      const auto place = locate_in_sites<Block, brick_cells>(frame, x, x + block_lanes, x + 2 * block_lanes);
      for (int l = 0; l < used; ++l) {
        const bool dense = 4 * mass[l] >= most * volume[l];  // as above: blocks differ by their other lanes
        f(static_cast<std::size_t>(place.node[l]), dense ? most : std::max(least, 4 * mass[l] / volume[l]));
      }
    }
    for (std::uint64_t cells = found.cells(); cells != 0; cells &= cells - 1)
      f(static_cast<std::size_t>(std::countr_zero(cells)), most);
  });
}

CellsInUse::Weights CellsInUse::find_heaviest(Slot s, std::int32_t component) const {
  Weights heaviest{};
  for_each_density(s, component, [&](std::size_t cell, double density) {
    heaviest[cell] = std::max(heaviest[cell], density);
  });
  return heaviest;
}

CellsInUse::Weights CellsInUse::find_lightest(Slot s, std::int32_t component, Weights& heaviest) const {
  Weights lightest{};
  heaviest = {};
  for_each_density(s, component, [&](std::size_t cell, double density) {
    if (lightest[cell] == 0 || density < lightest[cell]) lightest[cell] = density;
    heaviest[cell] = std::max(heaviest[cell], density);
  });
  return lightest;
}

void CellsInUse::find_own(Slot s) {
  BrickGrid& grid = *model_.grid;
  prefetch_coming_bricks(grid, s);
  if (!grid.has_fields_by_component()) {
    const std::optional<Cells> known = without_.empty() && !weighs_ ? grid.own_cells(s) : std::nullopt;
    if (known)
      cells(s, 0) = *known;
    else
      find_field(s, 0, all_components);
    return;
  }
  cells(s, 0) = 0;
  for (int f = 0; const std::int32_t component : grid.components(s)) find_field(s, f++, component);
}

void CellsInUse::find_field(Slot s, int field, std::int32_t component) {
  if (use_ == CellUse::lighter)
    take(s, field, find_lightest(s, component, heaviest_[model_.grid->field_index(s, field)]));
  else if (weighs_)
    take(s, field, find_heaviest(s, component));
  else
    cells(s, field) = find_cells(model_, s, component, without_);
}

void CellsInUse::take(Slot s, int field, const Weights& found) {
  Cells in_use = 0;
  double common = 0;
  for (std::size_t c = 0; c < found.size(); ++c) {
    if (found[c] == 0) continue;
    in_use |= Cells{1} << c;
    if (common == 0) common = found[c];
    if (found[c] != common) common = several;
  }
  const std::size_t at = model_.grid->field_index(s, field);
  cells_[at] = in_use;
  if (!weighs_) return;
  weights_[at] = found;
  common_weight_[at] = common;
}

void CellsInUse::write_to_nodes(Slot s) {
  BrickGrid& grid = *model_.grid;
  constexpr int width = record_doubles(node_fields.array);
  for (int f = 0; f < grid.velocity_fields(s); ++f) {
    double* at = grid.contributions(node_fields.array, s, f) + node_fields.first;
    for (int n = 0; n < grid.shape().nodes(); ++n) at[width * n] = 0;
    const std::size_t index = grid.field_index(s, f);
    for_each_cell_of(grid.shape(), [&](std::size_t cell, int node) {
      at[width * node] = weighs_ ? weights_[index][cell] : static_cast<double>(cells_[index] >> cell & 1);
    });
  }
}

void CellsInUse::read_from_nodes(Slot s) {
  const BrickGrid& grid = *model_.grid;
  constexpr int width = record_doubles(node_fields.array);
  for (int f = 0; f < grid.velocity_fields(s); ++f) {
    const double* at = grid.contributions(node_fields.array, s, f) + node_fields.first;
    Weights found;
    for_each_cell_of(grid.shape(), [&](std::size_t cell, int node) { found[cell] = at[width * node]; });
    take(s, f, found);
  }
}

void CellsInUse::find() {
  BrickGrid& grid = *model_.grid;
  cells_.resize(grid.field_count());
  weights_.resize(weighs_ ? grid.field_count() : 0);
  common_weight_.resize(weights_.size());
  heaviest_.resize(use_ == CellUse::lighter ? grid.field_count() : 0);
  for_each_by_threads(0, grid.boundary(), 4, [&](int s) {
    find_own(s);
    write_to_nodes(s);
  });
  halo_.begin(grid, node_fields);
  for_each_by_threads(grid.boundary(), grid.owned(), 4, [&](int s) { find_own(s); });
}

void CellsInUse::finish_exchange() {
  BrickGrid& grid = *model_.grid;
  halo_.end(grid);
  for (int g = 0; g < grid.ghosts(); ++g) read_from_nodes(grid.owned() + g);
  const bool keeps_weights = weighs_ && use_ == CellUse::means;
  grid.reset_cells_around(keeps_weights);
  for_each_by_threads(0, grid.owned(), 16, [&](int slot) {
    const auto s = static_cast<Slot>(slot);
    combine(s, all_components, grid.cells_around(s), keeps_weights ? &grid.cell_weights(s) : nullptr);
    if (!grid.has_fields_by_component()) return;
    for (int f = 0; const std::int32_t component : grid.components(s)) {
      combine(s, component, grid.cells_around(s, f), keeps_weights ? &grid.cell_weights(s, f) : nullptr);
      ++f;
    }
  });
}

/// f(index) for the fields of one component, or of all.
template <class F>
void CellsInUse::for_fields_of(Slot s, std::int32_t component, F f) const {
  const BrickGrid& grid = *model_.grid;
  if (component == all_components) {
    for (int field = 0; field < grid.velocity_fields(s); ++field) f(grid.field_index(s, field));
  } else if (const int field = grid.field_of(s, component); field >= 0) {
    f(grid.field_index(s, field));
  }
}

CellsInUse::Cells CellsInUse::cells_of(Slot s, std::int32_t component) const {
  Cells all = 0;
  for_fields_of(s, component, [&](std::size_t field) { all |= cells_[field]; });
  return all;
}

double CellsInUse::weight_of(Slot s, std::int32_t component, std::size_t cell) const {
  double weight = 0;
  for_fields_of(s, component, [&](std::size_t field) {
    const double of_field = weights_[field][cell];
    if (use_ == CellUse::means || weight == 0)
      weight = std::max(weight, of_field);
    else if (of_field != 0)
      weight = std::min(weight, of_field);
  });
  return weight;
}

/// Of those in use in a brick and its neighbours.
bool CellsInUse::weigh_alike(const Brick& brick, std::int32_t component) const {
  double common = 0;
  for (const Slot from : brick.neighbour) {
    if (from == no_slot) continue;
    for_fields_of(from, component, [&](std::size_t field) {
      const double weight = common_weight_[field];
      if (common == 0) common = weight;
      if (weight != 0 && weight != common) common = several;
    });
  }
  return common != several;
}

void CellsInUse::combine(Slot s, std::int32_t component, CellsAround& around,
                         CellWeightsAround* weights) const {
  if (use_ == CellUse::lighter) {
    around.beside_lighter = find_beside_lighter(s, component);
    return;
  }
  const Brick& brick = model_.grid->brick(s);
  const auto is_full = [&](Slot from) { return from != no_slot && cells_of(from, component) == ~Cells{0}; };
  if (weights != nullptr && weigh_alike(brick, component)) weights = nullptr;
  if (weights == nullptr && std::ranges::all_of(brick.neighbour, is_full)) return around.add_all();
  collect(s, component, around, weights);
  if (weights != nullptr && all_alike(*weights)) around.weights = nullptr;
}

/// A brick's own cells whose densest particles are much denser than the thinnest ones of the 27 cells around.
CellsInUse::Cells CellsInUse::find_beside_lighter(Slot s, std::int32_t component) const {
  const Brick& brick = model_.grid->brick(s);
  Weights heaviest{};
  double largest = 0;
  for_fields_of(s, component, [&](std::size_t field) {
    for (std::size_t cell = 0; cell < heaviest.size(); ++cell) {
      heaviest[cell] = std::max(heaviest[cell], heaviest_[field][cell]);
      largest = std::max(largest, heaviest[cell]);
    }
  });
  if (empty_density_ > 0) {
    if (!(largest > much_lighter * empty_density_)) return 0;
  } else if (weigh_alike(brick, component)) {
    double lightest = std::numeric_limits<double>::infinity();
    for_fields_of(s, component, [&](std::size_t field) {
      if (common_weight_[field] != 0) lightest = common_weight_[field];
    });
    if (!(largest > much_lighter * lightest)) return 0;
  }
  CellsAround around;
  CellWeightsAround lightest;
  collect(s, component, around, &lightest);
  const auto is_much_lighter = [&](double density, double than) {
    const double light = density == 0 ? empty_density_ : density;
    return light > 0 && than > much_lighter * light;
  };
  Cells beside = 0;
  for (std::size_t cell = 0; cell < heaviest.size(); ++cell) {
    if (heaviest[cell] == 0) continue;
    const auto number = static_cast<int>(cell);
    const int i = number % brick_cells, j = number / brick_cells % brick_cells,
              k = number / (brick_cells * brick_cells);
    bool found = false;
    for (int n = 0; n < neighbourhood && !found; ++n) {
      const BrickCoord d = neighbour_offset(n);
      found = is_much_lighter(around.weight(i + d.x, j + d.y, k + d.z), heaviest[cell]);
    }
    if (found) beside |= Cells{1} << cell;
  }
  return beside;
}

/// The cells of a brick and its neighbours, and their weights, if asked for.
void CellsInUse::collect(Slot s, std::int32_t component, CellsAround& around,
                         CellWeightsAround* weights) const {
  const BrickGrid& grid = *model_.grid;
  const Brick& brick = grid.brick(s);
  if (weights != nullptr) {
    *weights = {};
    around.weights = weights;
  }
  for (int n = 0; n < neighbourhood; ++n) {
    const Slot from = brick.neighbour[static_cast<std::size_t>(n)];
    if (from == no_slot) continue;
    const Cells there = cells_of(from, component);
    if (there == 0) continue;
    const BrickCoord d = neighbour_offset(n);
    const auto lowest = [](int offset) { return offset < 0 ? brick_cells - 1 : 0; };
    const auto highest = [](int offset) { return offset > 0 ? 0 : brick_cells - 1; };
    for (int k = lowest(d.z); k <= highest(d.z); ++k) {
      for (int j = lowest(d.y); j <= highest(d.y); ++j) {
        const auto row = static_cast<unsigned>(there >> brick_cells * (j + brick_cells * k)) & 15u;
        const unsigned within = d.x < 0 ? row >> 3 : d.x > 0 ? (row & 1u) << 5 : row << 1;
        const int at_j = j + brick_cells * d.y, at_k = k + brick_cells * d.z;
        around.add_row(at_j, at_k, within);
        if (weights == nullptr) continue;
        double* const to = weights->row[CellsAround::index(at_j, at_k)];
        for (int i = lowest(d.x); i <= highest(d.x); ++i) {
          const int number = i + brick_cells * (j + brick_cells * k);
          to[i + brick_cells * d.x + 1] = weight_of(from, component, static_cast<std::size_t>(number));
        }
      }
    }
  }
  add_mirror_images(grid.geometry(), brick.coord, around, weights);
}

std::unique_ptr<CellsInUse> make_cells_in_use(Model& model, NodeHalo& halo, std::vector<int> without) {
  using Made = std::unique_ptr<CellsInUse>;
  const auto make = [&](CellUse use) {
    return std::make_unique<CellsInUse>(model, halo, use, std::move(without));
  };
  return with_shape(model.scene->grid.shape, [&]<class S>(std::type_identity<S>) -> Made {
    if constexpr (needs_cells<S>) return make(CellUse::means);
    if constexpr (needs_lighter_cells<S>)
      if (may_be_much_lighter(model)) return make(CellUse::lighter);
    return nullptr;
  });
}

}  // namespace mpm::core
