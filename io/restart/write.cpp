#include <fmt/format.h>

#include "io/output/file.hpp"
#include "io/output/shared_rows.hpp"
#include "io/restart/contents.hpp"
#include "io/restart/files.hpp"
#include "io/restart/restart.hpp"

namespace mpm::io {

namespace {

constexpr std::size_t bytes_at_once = std::size_t{8} << 20;

/// Creates the file without its rows, and reserves their space.
std::vector<Extent> make_room(const std::string& part, const RestartContents& contents,
                              const core::Scene& scene) {
  // Tried before anything is written.
  File(part, File::Mode::write_anew).reserve(expected_bytes(contents));
  std::vector<Extent> rows = write_contents(part, contents, scene);
  File file(part, File::Mode::change);
  file.reserve(file.size());
  return rows;
}

void fill(const core::Model& model, const RowBatch& batch, int columns, double* rows) {
  for_each_block(model, batch, [&](const core::ConstParticleBlock& block, std::size_t first) {
    double* value = rows + first * static_cast<std::size_t>(columns);
    for (const core::ConstParticle p : block)
      for (int c = 0; c < columns; ++c) *value++ = p.nth(c);
  });
}

void write_all_rows(const std::string& part, const ParticleOrder& order, const core::Model& model,
                    core::Reductions& ranks) {
  const std::size_t bodies = model.bodies.size();
  std::vector<ParticleOrder> of_body(bodies);  // so that each body visits only its own tiles
  for (const TilePlace& place : order.mine) {
    const core::Brick& brick = model.grid->brick(place.slot);
    const int body = brick.tiles[static_cast<std::size_t>(place.tile)].body;
    of_body[static_cast<std::size_t>(body)].mine.push_back(place);
  }
  std::vector<std::int64_t> first_row(bodies, left_out);
  std::vector<std::vector<RowBatch>> batches(bodies);
  std::vector<SharedRows> datasets;
  for (std::size_t b = 0; b < bodies; ++b) {
    const core::ColumnLayout& layout = model.bodies[b].pool->layout();
    const auto bytes = static_cast<std::size_t>(layout.bytes_per_particle());
    first_row[b] = 0;
    batches[b] = cut_into_batches(model, of_body[b], first_row, bytes_at_once / bytes);
    first_row[b] = left_out;
    datasets.push_back({rows_name(b), bytes, batches[b],
                        [&model, columns = layout.columns()](const RowBatch& batch, std::byte* memory) {
                          fill(model, batch, columns, reinterpret_cast<double*>(memory));
                        }});
  }
  write_together(part, datasets, ranks);
  together(ranks, [&] { File(part, File::Mode::read).sync(); });
}

}  // namespace

std::string write_restart(const std::string& folder, const std::string& job, const core::Model& model,
                          const RestartExtra& extra, core::Reductions& ranks) {
  const std::string path = restart_path(folder, job, model.clock.step);
  const std::string part = part_name(path);
  const ParticleOrder order = order_particles(model, ranks, true);
  const RestartContents contents = contents_of(model, extra, order, ranks);
  try {
    std::vector<Extent> rows;
    together(ranks, [&] {
      if (ranks.rank() == 0) rows = make_room(part, contents, *model.scene);
    });
    write_all_rows(part, order, model, ranks);
    together(ranks, [&] {
      if (ranks.rank() != 0) return;
      seal(part, job, model.clock.step, youngest(folder, job), rows, contents.bodies.size());
      rename_file(part, path);
      remove_older(folder, job);
    });
  } catch (const FileError&) {
    if (ranks.rank() == 0) remove_file(part);
    throw;
  }
  return path;
}

}  // namespace mpm::io
