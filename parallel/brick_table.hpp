// Owner of each brick: every rank stores all bricks of the run. 16 bytes per entry, at most three quarters
// full.
#pragma once

#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/communication/brick_directory.hpp"

namespace mpm::parallel {

class BrickTable {
 public:
  static constexpr std::int32_t no_owner = core::BrickDirectory::no_owner;

  /// The rank that owns the brick; `no_owner` if it does not exist.
  std::int32_t owner(core::BrickCoord b) const { return entries_[place_of(core::key_of(b))].owner; }
  bool contains(core::BrickCoord b) const { return owner(b) != no_owner; }

  void assign(core::BrickCoord b, std::int32_t owner) {
    if (4 * (size_ + 1) > 3 * entries_.size()) grow();
    Entry& e = entries_[place_of(core::key_of(b))];
    if (e.owner == no_owner) ++size_;
    e = {core::key_of(b), owner};
  }

  void remove(core::BrickCoord b) {
    std::size_t hole = place_of(core::key_of(b));
    if (entries_[hole].owner == no_owner) return;
    --size_;
    // Entries displaced past the hole move back, so that searches still end at the first free entry.
    for (std::size_t i = after(hole); entries_[i].owner != no_owner; i = after(i)) {
      const std::size_t home = home_of(entries_[i].key);
      if (((i - home) & mask()) >= ((i - hole) & mask())) {
        entries_[hole] = entries_[i];
        hole = i;
      }
    }
    entries_[hole].owner = no_owner;
  }

  void clear() { *this = BrickTable(); }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return entries_.capacity() * sizeof(Entry); }

 private:
  struct Entry {
    core::BrickKey key = 0;
    std::int32_t owner = no_owner;
  };

  std::size_t mask() const { return entries_.size() - 1; }
  std::size_t after(std::size_t i) const { return (i + 1) & mask(); }
  /// Neighbouring bricks have neighbouring keys; Fibonacci hashing spreads them.
  std::size_t home_of(core::BrickKey key) const {
    return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15u) >> (64 - std::countr_zero(entries_.size())));
  }
  std::size_t place_of(core::BrickKey key) const {
    std::size_t i = home_of(key);
    while (entries_[i].owner != no_owner && entries_[i].key != key) i = after(i);
    return i;
  }
  void grow() {
    std::vector<Entry> old(2 * entries_.size());
    old.swap(entries_);
    for (const Entry& e : old) {
      if (e.owner != no_owner) entries_[place_of(e.key)] = e;
    }
  }

  std::vector<Entry> entries_ = std::vector<Entry>(16);  ///< a power of two
  std::size_t size_ = 0;
};

}  // namespace mpm::parallel
