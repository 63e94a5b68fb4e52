#include "io/output/particle_order.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include "core/communication/gather_records.hpp"
#include "core/threads.hpp"
#include "io/output/hash.hpp"

namespace mpm::io {

namespace {

/// Sorts are stable: a brick's tiles of the same body stay in their order.
bool before(const TileRecord& a, const TileRecord& b) {
  return std::tie(a.body, a.brick) < std::tie(b.body, b.brick);
}

/// Records and places of this rank, in matching order.
void collect(const core::Model& model, std::vector<TileRecord>& records, std::vector<TilePlace>& places) {
  struct Entry {
    TileRecord record;
    TilePlace place;
  };
  std::vector<Entry> entries;
  for (core::Slot s = 0; s < model.grid->owned(); ++s) {
    const core::Brick& brick = model.grid->brick(s);
    for (std::size_t c = 0; c < brick.tiles.size(); ++c) {
      const core::ParticleTile& tile = brick.tiles[c];
      if (tile.count == 0) continue;
      entries.push_back({{core::key_of(brick.coord), tile.body, tile.count, 0}, {s, static_cast<int>(c), 0}});
    }
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return before(a.record, b.record); });
  for (const Entry& e : entries) {
    records.push_back(e.record);
    places.push_back(e.place);
  }
}

void add_hashes(const core::Model& model, const std::vector<TilePlace>& places,
                std::vector<TileRecord>& records) {
  core::for_each_by_threads(std::size_t{0}, places.size(), 8, [&](std::size_t i) {
    thread_local std::vector<double> rows;
    rows.clear();
    int columns = 0;
    for (const core::ConstParticleBlock& block : blocks_at(model, places[i])) {
      columns = block.layout->columns();
      for (const core::ConstParticle p : block)
        for (int c = 0; c < columns; ++c) rows.push_back(p.nth(c));
    }
    records[i].hash = hash_of(records[i], rows.data(), columns);
  });
}

std::vector<TileRecord> all_records(const std::vector<TileRecord>& mine, core::Reductions& ranks) {
  std::vector<TileRecord> all = core::gather_records(std::span(mine), ranks);
  std::stable_sort(all.begin(), all.end(), before);
  return all;
}

}  // namespace

ParticleOrder order_particles(const core::Model& model, core::Reductions& ranks, bool hashes) {
  ParticleOrder order;
  std::vector<TileRecord> records;
  collect(model, records, order.mine);
  if (hashes) add_hashes(model, order.mine, records);
  order.tiles = all_records(records, ranks);
  order.particles.resize(model.bodies.size());
  std::size_t next = 0;  // of mine
  for (const TileRecord& r : order.tiles) {
    std::int64_t& rows = order.particles[static_cast<std::size_t>(r.body)];
    if (next < records.size() && records[next].body == r.body && records[next].brick == r.brick) {
      order.mine[next++].first_row = rows;
    }
    rows += static_cast<std::int64_t>(r.particles);
  }
  return order;
}

std::string described(const std::string& name, const core::ColumnSet& columns) {
  std::string text = name;
  for (int c = 0; c < core::column_count; ++c) {
    const auto column = static_cast<core::Column>(c);
    if (columns.has(column)) text.append(" ").append(core::name_of(column));
  }
  return text;
}

std::uint64_t state_hash(const std::vector<TileRecord>& tiles, const std::vector<std::string>& bodies) {
  Hash hash;
  for (const std::string& b : bodies) hash.add(b);
  for (const TileRecord& r : tiles) {
    hash.add(r.brick);
    hash.add(static_cast<std::uint64_t>(r.body));
    hash.add(r.particles);
    hash.add(r.hash);
  }
  return hash.value();
}

std::uint64_t state_hash(const core::Model& model, core::Reductions& ranks) {
  std::vector<std::string> bodies;
  for (const core::Body& b : model.bodies) bodies.push_back(described(b.name, b.pool->layout().set()));
  return state_hash(order_particles(model, ranks, true).tiles, bodies);
}

std::uint64_t hash_of(const TileRecord& record, const double* rows, int columns) {
  Hash hash;
  hash.add(record.brick);
  hash.add(static_cast<std::uint64_t>(record.body));
  hash.add(record.particles);
  hash.add(rows, static_cast<std::size_t>(columns) * record.particles);
  return hash.value();
}

}  // namespace mpm::io
