// Particles to grid, of the passes (passes_with.hpp, of which this is a part): what the particles of a tile,
// a brick or all bricks contribute to the nodes.
#pragma once

#include <algorithm>

#include "core/step/passes_with.hpp"

namespace mpm::core {

/// before(body, place, block, used) for every block of a tile, then its contribution to the nodes. A function
/// of its own, so that the sums of the current cell stay in registers: 40 % of this pass's time.
template <ShapePolicy S, TransferPolicy T>
template <NodeFields what, class Scatter, class F>
[[gnu::noinline]] void PassesWith<S, T>::map_tile(Slot s, std::size_t c, const BrickFrame& frame, Scratch& at,
                                                  const Weight& weight, double* contributions,
                                                  SpreadPrefetch& room, Scatter& running, double* records,
                                                  F before) {
  const BrickGrid& grid = *model_.grid;
  const ParticleTile& tile = grid.brick(s).tiles[c];
  const Body& body = model_.bodies[static_cast<std::size_t>(tile.body)];
  const BlockPrefetch prefetch(model_, s, c);
  const ColumnLayout& layout = body.pool->layout();
  const bool loaded = maps_force(what) && (weight.by_particle || loads_.act(grid, s, tile.body));
  const Vec3<double> acceleration = weight.by_particle ? loads_.acceleration(tile.body) : Vec3<double>{};
  SiteAverages* const pressures = maps_force(what) && averages_volume_change() ? &at.averages : nullptr;
  if (pressures != nullptr) sum_pressures(frame, tile, *pressures);
  Scatter cell = running;
  // Locates the next block before this one is processed, so that its stores complete before they are read.
  Place places[2];
  const auto find = [&](std::size_t b) {
    places[b % 2].find(frame, layout, body.pool->block(tile.blocks[b]), tile.used_lanes(b));
  };
  if (!tile.blocks.empty()) find(0);
  for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
    if constexpr (maps_momentum(what))
      prefetch.template request<S>(b, layout, maps_force(what) ? columns_to_stress : columns_to_mass);
    room.next();
    double* block = body.pool->block(tile.blocks[b]);
    const int used = tile.used_lanes(b);
    if (b + 1 < tile.blocks.size()) find(b + 1);
    const Place& place = places[b % 2];
    before(tile.body, place, block, used);
    add_block<S, T, what>(frame, place, layout, block, used, cell, records, pressures);
    if constexpr (maps_force(what)) {
      if (loaded)
        add_load_forces<S>(loads_, model_, s, tile.body, acceleration, place, block, used, contributions);
    }
  }
  running = cell;
}

template <ShapePolicy S, TransferPolicy T>
typename PassesWith<S, T>::Weight PassesWith<S, T>::weight_of(Slot s, std::int32_t component) const {
  Weight found;
  if (!loads_.any()) return found;
  bool first = true;
  for (const ParticleTile& tile : model_.grid->brick(s).tiles) {
    if (!holds(tile, component)) continue;
    const Vec3<double> acceleration = loads_.acceleration(tile.body);
    if (!first && acceleration != found.acceleration) return {{}, true};
    found.acceleration = acceleration;
    first = false;
  }
  return found;
}

/// before(body, place, block, used) for every block of a component, then its contribution to the nodes.
template <ShapePolicy S, TransferPolicy T>
template <NodeFields what, class F>
void PassesWith<S, T>::map_brick(Slot s, std::int32_t component, Scratch& at, F before) {
  BrickGrid& grid = *model_.grid;
  const Brick& brick = grid.brick(s);
  const BrickFrame frame = this->frame(s, component);
  constexpr int width = record_doubles(what.array);
  const int field = field_of(s, component);
  double* contributions = grid.contributions(what.array, s, field);
  using Sums = typename S::template Sums<what>;
  constexpr bool can_replace = requires(Sums sums) { sums.replace(frame); };
  const Weight weight = maps_force(what) ? weight_of(s, component) : Weight{};
  const auto loaded = [&](const ParticleTile& tile) {
    return weight.by_particle || loads_.act(grid, s, tile.body);
  };
  // Loads that particles map are added to the nodes themselves.
  const NodeMask* some = reached(s);
  const bool replaces =
      can_replace && some == nullptr && !(maps_force(what) && std::ranges::any_of(brick.tiles, loaded));
  // Of the nodes that it does not reach, the map of the new momentum needs no sums, but at walls, which fold
  // them.
  constexpr bool back = what.array == NodeArray::second;
  const bool all = !back || momentum_block<S> == S::node_block || !faces(s).none();
  const NodeSelection written{grid.shape(), all ? S::node_block : momentum_block<S>};
  if (selects_)
    sparse_.begin_map(what.array, grid.shape(), s, width, replaces, contributions);
  else if (!replaces)
    written.for_each(
        [&](int first, int nodes) { std::fill_n(contributions + width * first, width * nodes, 0.0); });
  const bool next_is_full = s + 1 < grid.owned() && !has_few_particles(s + 1);
  SpreadPrefetch room(next_is_full ? grid.contributions(what.array, s + 1) : nullptr,
                      width * grid.shape().nodes(), block_count(brick));
  Sums sums(contributions);
  typename S::template Scatter<what> cell;
  cell.clear();
  for (std::size_t c = 0; c < brick.tiles.size(); ++c) {
    if (holds(brick.tiles[c], component))
      map_tile<what>(s, c, frame, at, weight, contributions, room, cell, sums.records, before);
  }
  cell.flush(frame, sums.records);
  if constexpr (can_replace) {
    if (replaces) sums.replace(frame);
  }
  if (!replaces) sums.finish(frame, some);
  if constexpr (S::node_block != NodeBlockShape{}) faces(s).fold(what, contributions);
  if constexpr (maps_force(what)) add_weight<what>(s, field, weight.acceleration, contributions);
}

/// Sums a tile's pressures in its sites.
template <ShapePolicy S, TransferPolicy T>
[[gnu::noinline]] void PassesWith<S, T>::sum_pressures(const BrickFrame& frame, const ParticleTile& tile,
                                                       SiteAverages& to) const {
  BlockPool& pool = *model_.bodies[static_cast<std::size_t>(tile.body)].pool;
  to.clear();
  for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
    const double* block = pool.block(tile.blocks[b]);
    const Place place(frame, pool.layout(), block, tile.used_lanes(b));
    to.add_pressures(sites_of(place), pool.layout(), block, tile.used_lanes(b));
  }
}

/// Adds the weight by loads to folded contributions, and to that and gravity, which the nodes' equation of
/// motion adds, what walls reverse.
template <ShapePolicy S, TransferPolicy T>
template <NodeFields what>
void PassesWith<S, T>::add_weight(Slot s, int field, const Vec3<double>& acceleration,
                                  double* contributions) {
  constexpr NodeArray array = maps_mass(what) ? what.array : NodeArray::sixth;
  constexpr bool folds = S::node_block != NodeBlockShape{};
  const bool accelerates = acceleration != Vec3<double>{};
  if (!accelerates && !folds) return;
  const double* masses = model_.grid->contributions(array, s, field);
  if (accelerates) add_weights(acceleration, shared_.nodes(), array, masses, contributions);
  if constexpr (folds) faces(s).reverse_weights(forces_.gravity + acceleration, array, masses, contributions);
}

/// Those of a brick with few particles, inside the grid's faces and without loads.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::find_reached(Slot s) {
  if constexpr (Traits::selects) {
    const BrickGrid& grid = *model_.grid;
    const Brick& brick = grid.brick(s);
    if (!has_few_particles(s)) return sparse_.set_all(s);
    const auto loaded = [&](const ParticleTile& tile) {
      return loads_.act(grid, s, tile.body) || loads_.acceleration(tile.body) != Vec3<double>{};
    };
    if (!faces(s).none() || std::ranges::any_of(brick.tiles, loaded)) return sparse_.set_all(s);
    NodeMask nodes;
    const BrickFrame frame = this->frame(s);
    for (const ParticleTile& tile : brick.tiles) {
      BlockPool& pool = *model_.bodies[static_cast<std::size_t>(tile.body)].pool;
      for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
        const int used = tile.used_lanes(b);
        const Place place(frame, pool.layout(), pool.block(tile.blocks[b]), used);
        for (int l = 0; l < used; ++l) nodes.add(grid.shape(), S::lowest_of(place, l), S::nodes_per_axis);
      }
    }
    sparse_.set_some(s, nodes);
  }
}

template <ShapePolicy S, TransferPolicy T>
template <NodeFields what>
void PassesWith<S, T>::map_to_grid() {
  const bool finds_ranges = maps_mass(what) && finds_ranges_;
  if (finds_ranges) ranges_.resize(static_cast<std::size_t>(model_.grid->owned()));
  map_bricks<what>([&](Slot s, Scratch& at) {
    if (finds_ranges) ranges_[static_cast<std::size_t>(s)] = velocity_range(model_, s);
    if (selects_) find_reached(s);
    for_each_own_field(s, [&](std::int32_t component) {
      map_brick<what>(s, component, at, [](int, const Place&, double*, int) {});
    });
  });
}

}  // namespace mpm::core
