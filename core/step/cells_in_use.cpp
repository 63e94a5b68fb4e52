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

constexpr double infinity = std::numeric_limits<double>::infinity();

double largest_density(const std::vector<Body>& bodies) {
  double largest = 0;
  for (const Body& body : bodies) largest = std::max(largest, body.model->reference_density());
  return largest;
}

double least_density(const std::vector<Body>& bodies) {
  double least = infinity;
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

/// The least of the 27 values around each of a brick's cells, by the number of its bit; of cells without one,
/// `none`. One axis after the other, in place.
std::array<double, brick_cells * brick_cells * brick_cells> least_around(const CellWeightsAround& values,
                                                                         double none) {
  constexpr int side = CellsAround::side;
  double v[side][side][side];
  for (int k = 0; k < side; ++k) {
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        const double value = values.row[CellsAround::index(j - 1, k - 1)][i];
        v[k][j][i] = value == 0 ? none : value;
      }
    }
  }
  for (auto& layer : v)
    for (auto& row : layer)
      for (int i = 0; i < brick_cells; ++i) row[i] = std::min({row[i], row[i + 1], row[i + 2]});
  for (auto& layer : v)
    for (int j = 0; j < brick_cells; ++j)
      for (int i = 0; i < brick_cells; ++i)
        layer[j][i] = std::min({layer[j][i], layer[j + 1][i], layer[j + 2][i]});
  std::array<double, brick_cells * brick_cells * brick_cells> least;
  for (std::size_t c = 0; c < least.size(); ++c) {
    const std::size_t i = c % brick_cells, j = c / brick_cells % brick_cells,
                      k = c / (brick_cells * brick_cells);
    least[c] = std::min({v[k][j][i], v[k + 1][j][i], v[k + 2][j][i]});
  }
  return least;
}

/// f(number of its bit, node of the brick's node block) for each cell. The outer cells, of which other bricks
/// need to know, are at the outer nodes, which other ranks get.
template <class F>
void for_each_cell_of(const NodeBlockShape& shape, F f) {
  for (int k = 0; k < brick_cells; ++k) {
    for (int j = 0; j < brick_cells; ++j) {
      for (int i = 0; i < brick_cells; ++i)
        f(static_cast<std::size_t>(i + brick_cells * (j + brick_cells * k)),
          shape.index(i + i / 2, j + j / 2, k + k / 2));
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

CellsInUse::CellsInUse(Model& model, NodeHalo& halo, CellNeeds needs, std::vector<int> without)
    : model_(model),
      halo_(halo),
      without_(std::move(without)),
      needs_(needs),
      largest_weight_(largest_density(model.bodies) / 10),
      // USL's remedy for light nodes at free surfaces (core/step/node_update.hpp) is one for the lightest
      // material.
      empty_density_(model.scheme == Scheme::usl ? least_density(model.bodies) : 0) {}

NodeFields CellsInUse::exchanged() const {
  if (!needs_.lighter) return mapped::cells_in_use;
  return needs_.use ? mapped::cells_in_use_and_thinnest : mapped::thinnest_of_cells;
}

CellsInUse::Range CellsInUse::range_of(Slot s) const {
  Range range;
  for_each_tile(model_.grid->brick(s), all_components, without_, [&](const ParticleTile& tile, std::size_t) {
    if (tile.blocks.empty()) return;
    const double density = model_.bodies[static_cast<std::size_t>(tile.body)].model->reference_density();
    range.include({density, density});
  });
  return range;
}

/// By the bodies that have particles in the brick and around it, as far as this rank knows them.
bool CellsInUse::may_be_beside_lighter(Slot s) const {
  const BrickGrid& grid = *model_.grid;
  Range range;
  if (empty_density_ > 0) range.thinnest = empty_density_;
  for (const Slot from : grid.brick(s).neighbour) {
    if (from == no_slot) continue;
    if (from >= grid.owned()) return true;
    range.include(ranges_[static_cast<std::size_t>(from)]);
  }
  return range.differs_much();
}

/// A cell weighs as much as its densest particle, whose density is the least of its material's density of
/// reference, 4 m/V and the largest weight. So solids always weigh the same, materials weigh alike whose
/// densities differ up to tenfold, and gases weigh less once they have expanded much.
CellsInUse::Found CellsInUse::find_densities(Slot s, std::int32_t component) const {
  using Block = Lanes<block_lanes>;
  constexpr double least = std::numeric_limits<double>::min();
  const Brick& brick = model_.grid->brick(s);
  const BrickFrame frame(model_.grid->geometry(), brick.coord);
  const int columns = static_cast<int>(needs_.weights ? Column::volume : Column::position_z) + 1;
  Found to;
  for_each_tile(brick, component, without_, [&](const ParticleTile& tile, std::size_t c) {
    const Body& body = model_.bodies[static_cast<std::size_t>(tile.body)];
    const ColumnLayout& layout = body.pool->layout();
    const double density = std::max(body.model->reference_density(), least),
                 most = std::min(density, largest_weight_);
    const BlockPrefetch prefetch(model_, s, c);
    const auto add = [&](int cell, double weight) {
      const auto at = static_cast<std::size_t>(cell);
      to.weight[at] = std::max(to.weight[at], weight);
      to.densest[at] = std::max(to.densest[at], density);
      if (to.thinnest[at] == 0 || density < to.thinnest[at]) to.thinnest[at] = density;
    };
    CellsOfParticles found;  // of blocks without thin particles
    for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
      prefetch.request<Linear>(b, layout, columns);
      const double* block = body.pool->block(tile.blocks[b]);
      const int used = tile.used_lanes(b);
      const double *x = block + layout.offset(Column::position_x),
                   *mass = block + layout.offset(Column::mass),
                   *volume = block + layout.offset(Column::volume);
      if (!needs_.weights || all(Block(4.0) * load<Block>(mass) >= Block(most) * load<Block>(volume))) {
        found.add(frame, layout, block, (1u << used) - 1);
        continue;
      }
      const auto place = locate_in_sites<Block, brick_cells>(frame, x, x + block_lanes, x + 2 * block_lanes);
      for (int l = 0; l < used; ++l) {
        const bool dense = 4 * mass[l] >= most * volume[l];  // as above: blocks differ by their other lanes
        add(place.node[l], dense ? most : std::max(least, 4 * mass[l] / volume[l]));
      }
    }
    for (std::uint64_t cells = found.cells(); cells != 0; cells &= cells - 1)
      add(std::countr_zero(cells), most);
  });
  return to;
}

void CellsInUse::find_own(Slot s) {
  BrickGrid& grid = *model_.grid;
  prefetch_coming_bricks(grid, s);
  if (!grid.has_fields_by_component()) {
    const std::optional<Cells> known =
        without_.empty() && !needs_.densities() ? grid.own_cells(s) : std::nullopt;
    if (known)
      cells(s, 0) = *known;
    else
      find_field(s, 0, all_components);
    return;
  }
  if (needs_.densities())
    take(grid.field_index(s, 0), {});
  else
    cells(s, 0) = 0;
  for (int f = 0; const std::int32_t component : grid.components(s)) find_field(s, f++, component);
}

void CellsInUse::find_field(Slot s, int field, std::int32_t component) {
  const std::size_t at = model_.grid->field_index(s, field);
  if (!needs_.densities())
    cells_[at] = find_cells(model_, s, component, without_);
  else if (needs_.use || may_be_beside_lighter(s))
    take(at, find_densities(s, component));
  else
    take(at, {});
}

void CellsInUse::take(std::size_t at, const Found& found) {
  Cells in_use = 0;
  double common = 0;
  for (std::size_t c = 0; c < found.weight.size(); ++c) {
    const double weight = found.weight[c];
    if (weight == 0 && found.thinnest[c] == 0) continue;
    common = in_use == 0 || weight == common ? weight : several;
    in_use |= Cells{1} << c;
  }
  cells_[at] = in_use;
  found_[at] = found;
  common_weight_[at] = common;
}

/// Densities are in a force's place, and would act on nodes that a map of few particles does not clear
/// (core/step/sparse_bricks.hpp).
void CellsInUse::clear_nodes(Slot s) {
  BrickGrid& grid = *model_.grid;
  const NodeFields fields = exchanged();
  const int width = record_doubles(fields.array);
  for (int f = 0; f < grid.velocity_fields(s); ++f) {
    double* records = grid.contributions(fields.array, s, f);
    for (int n = 0; n < grid.shape().nodes(); ++n)
      std::fill_n(records + width * n + fields.first, fields.count, 0.0);
  }
}

void CellsInUse::write_to_nodes(Slot s) {
  BrickGrid& grid = *model_.grid;
  const int width = record_doubles(exchanged().array);
  clear_nodes(s);
  for (int f = 0; f < grid.velocity_fields(s); ++f) {
    double* records = grid.contributions(exchanged().array, s, f);
    const std::size_t at = grid.field_index(s, f);
    for_each_cell_of(grid.shape(), [&](std::size_t cell, int node) {
      double* record = records + width * node;
      if (needs_.use)
        record[node_field::cells_in_use.first] =
            needs_.densities() ? found_[at].weight[cell] : static_cast<double>(cells_[at] >> cell & 1);
      if (needs_.lighter) record[node_field::thinnest_of_cells.first] = found_[at].thinnest[cell];
    });
  }
}

void CellsInUse::read_from_nodes(Slot s) {
  const BrickGrid& grid = *model_.grid;
  const int width = record_doubles(exchanged().array);
  for (int f = 0; f < grid.velocity_fields(s); ++f) {
    const double* records = grid.contributions(exchanged().array, s, f);
    Cells in_use = 0;
    Found found;
    for_each_cell_of(grid.shape(), [&](std::size_t cell, int node) {
      const double* record = records + width * node;
      if (needs_.use) found.weight[cell] = record[node_field::cells_in_use.first];
      if (needs_.lighter) found.thinnest[cell] = record[node_field::thinnest_of_cells.first];
      if (found.weight[cell] != 0) in_use |= Cells{1} << cell;
    });
    const std::size_t at = grid.field_index(s, f);
    if (needs_.densities())
      take(at, found);
    else
      cells_[at] = in_use;
  }
}

void CellsInUse::find() {
  BrickGrid& grid = *model_.grid;
  cells_.resize(grid.field_count());
  found_.resize(needs_.densities() ? grid.field_count() : 0);
  common_weight_.resize(found_.size());
  if (needs_.lighter) {
    ranges_.resize(static_cast<std::size_t>(grid.owned()));
    for_each_by_threads(0, grid.owned(), 64,
                        [&](int s) { ranges_[static_cast<std::size_t>(s)] = range_of(s); });
  }
  for_each_by_threads(0, grid.boundary(), 4, [&](int s) {
    find_own(s);
    write_to_nodes(s);
  });
  halo_.begin(grid, exchanged());
  for_each_by_threads(grid.boundary(), grid.owned(), 4, [&](int s) { find_own(s); });
}

void CellsInUse::finish_exchange() {
  BrickGrid& grid = *model_.grid;
  halo_.end(grid);
  for (int g = 0; g < grid.ghosts(); ++g) read_from_nodes(grid.owned() + g);
  if (needs_.lighter) {
    for_each_by_threads(0, grid.boundary(), 16, [&](int s) { clear_nodes(s); });
    for_each_by_threads(grid.owned(), grid.owned() + grid.ghosts(), 16, [&](int s) { clear_nodes(s); });
  }
  grid.reset_cells_around(needs_.weights);
  for_each_by_threads(0, grid.owned(), 16, [&](int slot) {
    const auto s = static_cast<Slot>(slot);
    combine(s, all_components, grid.cells_around(s), needs_.weights ? &grid.cell_weights(s) : nullptr);
    if (!grid.has_fields_by_component()) return;
    for (int f = 0; const std::int32_t component : grid.components(s)) {
      combine(s, component, grid.cells_around(s, f), needs_.weights ? &grid.cell_weights(s, f) : nullptr);
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

double CellsInUse::largest_of(const OfCells Found::*what, Slot s, std::int32_t component,
                              std::size_t cell) const {
  double largest = 0;
  for_fields_of(s, component,
                [&](std::size_t field) { largest = std::max(largest, (found_[field].*what)[cell]); });
  return largest;
}

double CellsInUse::thinnest_of(Slot s, std::int32_t component, std::size_t cell) const {
  double thinnest = 0;
  for_fields_of(s, component, [&](std::size_t field) {
    const double density = found_[field].thinnest[cell];
    if (thinnest == 0 || (density != 0 && density < thinnest)) thinnest = density;
  });
  return thinnest;
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
  if (needs_.use) combine_use(s, component, around, weights);
  if (needs_.lighter) around.beside_lighter = find_beside_lighter(s, component);
}

void CellsInUse::combine_use(Slot s, std::int32_t component, CellsAround& around,
                             CellWeightsAround* weights) const {
  const Brick& brick = model_.grid->brick(s);
  const auto is_full = [&](Slot from) { return from != no_slot && cells_of(from, component) == ~Cells{0}; };
  if (weights != nullptr && weigh_alike(brick, component)) weights = nullptr;
  if (weights == nullptr && std::ranges::all_of(brick.neighbour, is_full)) return around.add_all();
  collect(s, component, around, weights,
          [&](Slot from, std::size_t cell) { return largest_of(&Found::weight, from, component, cell); });
  if (weights != nullptr && all_alike(*weights)) around.weights = nullptr;
}

/// A brick's own cells whose densest particles are much denser than the thinnest ones of the 27 cells around.
CellsInUse::Cells CellsInUse::find_beside_lighter(Slot s, std::int32_t component) const {
  if (!may_be_beside_lighter(s)) return 0;
  CellsAround around;
  CellWeightsAround densities;
  collect(s, component, around, &densities,
          [&](Slot from, std::size_t cell) { return thinnest_of(from, component, cell); });
  const OfCells least = least_around(densities, empty_density_ > 0 ? empty_density_ : infinity);
  Cells beside = 0;
  for (Cells own = cells_of(s, component); own != 0; own &= own - 1) {
    const auto cell = static_cast<std::size_t>(std::countr_zero(own));
    if (largest_of(&Found::densest, s, component, cell) > much_lighter * least[cell])
      beside |= Cells{1} << cell;
  }
  return beside;
}

/// The cells of a brick and its neighbours, and value(brick, number of the cell's bit) of each, if asked for.
template <class F>
void CellsInUse::collect(Slot s, std::int32_t component, CellsAround& around, CellWeightsAround* values,
                         F value) const {
  const BrickGrid& grid = *model_.grid;
  const Brick& brick = grid.brick(s);
  if (values != nullptr) {
    *values = {};
    around.weights = values;
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
        if (values == nullptr) continue;
        double* const to = values->row[CellsAround::index(at_j, at_k)];
        for (int i = lowest(d.x); i <= highest(d.x); ++i) {
          const int number = i + brick_cells * (j + brick_cells * k);
          to[i + brick_cells * d.x + 1] = value(from, static_cast<std::size_t>(number));
        }
      }
    }
  }
  add_mirror_images(grid.geometry(), brick.coord, around, values);
}

std::unique_ptr<CellsInUse> make_cells_in_use(Model& model, NodeHalo& halo, std::vector<int> without) {
  const auto is_of_another_material = [&](const Body& b) { return b.material != model.bodies[0].material; };
  const bool several = std::ranges::any_of(model.bodies, is_of_another_material);
  const CellNeeds needs =
      with_shape(model.scene->grid.shape, [&]<class S>(std::type_identity<S>) -> CellNeeds {
        return {.use = needs_cells<S>,
                .weights = needs_cells<S> && several,
                .lighter = needs_lighter_cells<S> && may_be_much_lighter(model)};
      });
  if (!needs.use && !needs.lighter) return nullptr;
  return std::make_unique<CellsInUse>(model, halo, needs, std::move(without));
}

}  // namespace mpm::core
