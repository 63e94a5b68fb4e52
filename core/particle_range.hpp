// This rank's particles as ranges: for (ParticleBlock b : blocks_of(model)), of one brick, or of one tile;
// and for (Particle p : b), each particle of a block. Blocks come in storage order: brick by brick, a brick's
// tiles by body. The kernels of the step have their own loops with prefetching (core/step/passes_with.hpp).
#pragma once

#include <algorithm>
#include <iterator>
#include <span>
#include <type_traits>

#include "core/model.hpp"
#include "core/particles/particle_view.hpp"

namespace mpm::core {

/// The blocks of these bricks' tiles of the bodies [first_body, last_body), of a component or of all.
template <class M>
class BlockRange {
  using Value = std::conditional_t<std::is_const_v<M>, const double, double>;

 public:
  BlockRange(M& model, std::span<const Brick> bricks, int first_body, int last_body,
             std::int32_t component = all_components)
      : model_(model),
        bricks_(bricks),
        first_body_(first_body),
        last_body_(last_body),
        component_(component) {}

  class Iterator {
   public:
    using difference_type = std::ptrdiff_t;
    using value_type = ParticleBlockOf<Value>;

    explicit Iterator(const BlockRange& of) : of_(&of), brick_(of.bricks_.begin()) {
      if (brick_ != of.bricks_.end()) find_tile(first_tile());
    }

    value_type operator*() const {
      const ParticleTile& tile = brick_->tiles[tile_];
      return {tile.body, &pool_->layout(), pool_->block(tile.blocks[block_]), tile.used_lanes(block_)};
    }
    Iterator& operator++() {
      if (++block_ == brick_->tiles[tile_].blocks.size()) find_tile(tile_ + 1);
      return *this;
    }
    bool operator==(std::default_sentinel_t) const { return brick_ == of_->bricks_.end(); }

   private:
    std::size_t first_tile() const {
      const auto at = std::ranges::lower_bound(brick_->tiles, of_->first_body_, {}, &ParticleTile::body);
      return static_cast<std::size_t>(at - brick_->tiles.begin());
    }
    /// Finds the next non-empty tile of these bodies, starting with this tile of the brick.
    void find_tile(std::size_t tile) {
      block_ = 0;
      while (brick_ != of_->bricks_.end()) {
        for (tile_ = tile; tile_ < brick_->tiles.size(); ++tile_) {
          const ParticleTile& c = brick_->tiles[tile_];
          if (c.body >= of_->last_body_) break;
          if (c.blocks.empty() || !of_->holds(c)) continue;
          pool_ = of_->model_.bodies[static_cast<std::size_t>(c.body)].pool.get();
          return;
        }
        if (++brick_ != of_->bricks_.end()) tile = first_tile();
      }
    }

    const BlockRange* of_;
    std::span<const Brick>::iterator brick_;
    std::size_t tile_ = 0, block_ = 0;
    std::conditional_t<std::is_const_v<M>, const BlockPool*, BlockPool*> pool_ = nullptr;
  };

  Iterator begin() const { return Iterator(*this); }
  std::default_sentinel_t end() const { return {}; }

 private:
  bool holds(const ParticleTile& tile) const {
    return component_ == all_components || tile.component == component_;
  }

  M& model_;
  std::span<const Brick> bricks_;
  int first_body_, last_body_;
  std::int32_t component_;
};

/// Of all particles of this rank.
template <class M>
BlockRange<M> blocks_of(M& model) {
  return {model, model.grid->bricks(), 0, static_cast<int>(model.bodies.size())};
}
/// Of a brick's particles.
template <class M>
BlockRange<M> blocks_of(M& model, const Brick& brick) {
  return {model, {&brick, 1}, 0, static_cast<int>(model.bodies.size())};
}
/// Of a brick's particles of one body, or of consecutive bodies.
template <class M>
BlockRange<M> blocks_of(M& model, const Brick& brick, int first_body, int last_body) {
  return {model, {&brick, 1}, first_body, last_body};
}
/// Of one of a brick's tiles.
template <class M>
BlockRange<M> blocks_of(M& model, const Brick& brick, const ParticleTile& tile) {
  return {model, {&brick, 1}, tile.body, tile.body + 1, tile.component};
}

}  // namespace mpm::core
