#include "io/output/h5part.hpp"

#include <algorithm>
#include <filesystem>
#include <numeric>

#include <fmt/format.h>

#include "io/output/file.hpp"
#include "io/output/hash.hpp"
#include "io/output/hdf5.hpp"
#include "io/output/shared_rows.hpp"

namespace mpm::io {

namespace {

using Field = H5PartWriter::Field;
using Kind = Field::Kind;

constexpr std::size_t particles_at_once = std::size_t{1} << 19;
/// Generous bounds on the bytes that a group, an attribute and a dataset add to their values.
constexpr std::uint64_t bytes_per_group = 16384;
constexpr std::uint64_t bytes_per_field = 2048;
/// Group of a time before it is renamed.
constexpr const char* workshop = "unfinished";
constexpr const char* work = "unfinished/step";
/// Upper bound of the size of a file without times.
constexpr std::uint64_t bytes_of_file = 131072;

std::vector<Field> fields_for(const std::vector<Variable>& variables) {
  std::vector<Field> fields{{"x", Kind::real, Variable::posx},
                            {"y", Kind::real, Variable::posy},
                            {"z", Kind::real, Variable::posz},
                            {"velocity_0", Kind::real, Variable::velocity_0},
                            {"velocity_1", Kind::real, Variable::velocity_1},
                            {"velocity_2", Kind::real, Variable::velocity_2},
                            {"id", Kind::identity, Variable::count},
                            {"body", Kind::integer, Variable::body}};
  for (const Variable v : variables) {
    const VariableInfo& info = info_of(v);
    const auto same = [&](const Field& f) { return f.name == info.name; };
    if (std::any_of(fields.begin(), fields.end(), same)) continue;
    fields.push_back({std::string(info.name), info.integer ? Kind::integer : Kind::real, v});
  }
  return fields;
}

struct Type {
  hid_t id;
  std::size_t bytes;
};

Type type_of(Kind kind, bool double_precision) {
  switch (kind) {
    case Kind::identity: return {H5T_STD_I64LE, 8};
    case Kind::integer: return {H5T_STD_I32LE, 4};
    case Kind::real: break;
  }
  if (double_precision) return {H5T_IEEE_F64LE, 8};
  return {H5T_IEEE_F32LE, 4};
}

std::string group_name(int n) { return fmt::format("Step#{}", n); }

std::vector<BodyFacts> facts_of_all(const core::Model& model) {
  std::vector<BodyFacts> facts;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) facts.push_back(facts_of(model, b));
  return facts;
}

/// Returns the number of clipped values.
template <class T>
std::int64_t fill(const core::Model& model, const RowBatch& batch, const Field& field,
                  const std::vector<BodyFacts>& facts, std::byte* memory) {
  T* out = reinterpret_cast<T*>(memory);
  std::int64_t all_cut = 0;
  for_each_block(model, batch, [&](const core::ConstParticleBlock& block, std::size_t row) {
    std::int64_t cut = 0;
    for (const core::ConstParticle p : block) {
      const double value = field.kind == Kind::identity
                               ? p[core::Column::identity]
                               : evaluate(field.variable, p, facts[static_cast<std::size_t>(block.body)]);
      out[row++] = narrowed<T>(value, cut);
    }
    if (cut > 0) {
#pragma omp atomic
      all_cut += cut;
    }
  });
  return all_cut;
}

std::int64_t fill(const core::Model& model, const RowBatch& batch, const Field& field, bool double_precision,
                  const std::vector<BodyFacts>& facts, std::byte* memory) {
  switch (field.kind) {
    case Kind::identity: return fill<std::int64_t>(model, batch, field, facts, memory);
    case Kind::integer: return fill<std::int32_t>(model, batch, field, facts, memory);
    case Kind::real: break;
  }
  return double_precision ? fill<double>(model, batch, field, facts, memory)
                          : fill<float>(model, batch, field, facts, memory);
}

}  // namespace

H5PartWriter::H5PartWriter(Settings settings, const core::Model& model, core::Reductions& ranks)
    : settings_(std::move(settings)), fields_(fields_for(settings_.variables)) {
  if (go_on(ranks)) return;
  mark_ = {};
  together(ranks, [&] {
    if (ranks.rank() == 0) create(*model.scene);
  });
}

bool H5PartWriter::go_on(core::Reductions& ranks) {
  if (!settings_.continue_from) return false;
  const std::string& path = settings_.path;
  const std::optional<H5PartMark> mark = H5PartMark::from(*settings_.continue_from);
  if (!ranks.any(ranks.rank() == 0 && std::filesystem::exists(path))) {
    if (mark && mark->times > 0)
      notice_ = fmt::format("'{}' is missing; it had {} time(s): a new file is started", path, mark->times);
    return false;
  }
  std::string aside = path + ".damaged", fault;
  if (mark) {
    fault = restore(path, *mark, ranks);
  } else {
    fault = fmt::format("the restart file has no record of '{}'", path);
    aside = path + ".old";
  }
  if (fault.empty()) {
    mark_ = *mark;
    return true;
  }
  notice_ = fmt::format("{}; it has been renamed to '{}', and a new file is started", fault, aside);
  together(ranks, [&] {
    if (ranks.rank() == 0) rename_file(path, aside);
  });
  return false;
}

void H5PartWriter::create(const core::Scene& scene) {
  const std::string part = part_name(settings_.path);
  File(part, File::Mode::write_anew).reserve(bytes_of_file);
  hdf5::Handle file = hdf5::create_file(part, 0, true);
  hdf5::write_attribute(file, provenance_of(scene));
  hdf5::create_group(file, workshop);
  file.close("write '" + part + "'");
  mark_.head = std::filesystem::file_size(part);
  rename_file(part, settings_.path);
}

void H5PartWriter::add_step(const core::Clock& clock, std::int64_t particles) {
  std::uint64_t need = bytes_per_group;
  for (const Field& f : fields_) {
    need += bytes_per_field +
            static_cast<std::uint64_t>(particles) * type_of(f.kind, settings_.double_precision).bytes;
  }
  {
    File space(settings_.path, File::Mode::change);
    space.reserve(space.size() + need);
  }
  hdf5::Handle file = hdf5::open_file(settings_.path, hdf5::Access::change);
  {
    if (hdf5::has_link(file, work))
      hdf5::check(H5Ldelete(file, work, H5P_DEFAULT), "remove the remains of a failed attempt");
    const hdf5::Handle group = hdf5::create_group(file, work);
    hdf5::write_attribute(group, "TimeValue", clock.time);
    hdf5::write_attribute(group, "step", clock.step);
    const auto rows = static_cast<hsize_t>(particles);
    for (const Field& f : fields_) {
      hdf5::create_dataset(group, f.name, type_of(f.kind, settings_.double_precision).id,
                           std::span(&rows, 1));
    }
  }
  file.close("write '" + settings_.path + "'");
}

void H5PartWriter::write_fields(const core::Model& model, core::Reductions& ranks,
                                const std::vector<RowBatch>& batches) {
  const std::vector<BodyFacts> facts = facts_of_all(model);
  std::vector<std::uint64_t> checksums(fields_.size());
  std::vector<SharedRows> datasets;
  // By field and batch, since each may be filled more than once.
  std::vector<std::vector<std::int64_t>> cut(fields_.size(), std::vector<std::int64_t>(batches.size()));
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    const Field& field = fields_[f];
    std::vector<std::int64_t>& of_field = cut[f];
    datasets.push_back({std::string(work) + "/" + field.name,
                        type_of(field.kind, settings_.double_precision).bytes, batches,
                        [&](const RowBatch& batch, std::byte* memory) {
                          of_field[static_cast<std::size_t>(&batch - batches.data())] =
                              fill(model, batch, field, settings_.double_precision, facts, memory);
                        },
                        &checksums[f]});
  }
  const std::vector<Extent> extents = write_together(settings_.path, datasets, ranks);
  sum_checksums(checksums, ranks);
  unnamed_.clear();
  std::vector<std::string> names;
  std::vector<std::int64_t> counts;
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    if (extents[f].size > 0) unnamed_.push_back({extents[f], datasets[f].bytes, checksums[f]});
    names.push_back(fields_[f].name);
    counts.push_back(std::accumulate(cut[f].begin(), cut[f].end(), std::int64_t{0}));
  }
  warning_ = cut_.warning(settings_.path, model.clock.step, names, std::move(counts), ranks);
}

void H5PartWriter::name_step() {
  {
    File space(settings_.path, File::Mode::change);
    space.reserve(space.size() + bytes_per_group);
  }
  Hash checksum;
  for (const H5PartMark::Rows& rows : unnamed_) checksum.add(rows.checksum);
  hdf5::Handle file = hdf5::open_file(settings_.path, hdf5::Access::change);
  hdf5::write_attribute(hdf5::open_group(file, work), "checksum",
                        static_cast<std::int64_t>(checksum.value()));
  hdf5::rename_link(file, work, group_name(times()));
  file.close("write '" + settings_.path + "'");
}

void H5PartWriter::write(const core::Model& model, core::Reductions& ranks) {
  const ParticleOrder order = order_particles(model, ranks, false);
  std::vector<std::int64_t> first_row(model.bodies.size(), left_out);
  std::int64_t particles = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (model.bodies[b].no_output) continue;
    first_row[b] = particles;
    particles += order.particles[b];
  }
  const std::vector<RowBatch> batches = cut_into_batches(model, order, first_row, particles_at_once);

  together(ranks, [&] {
    if (ranks.rank() == 0) add_step(model.clock, particles);
  });
  write_fields(model, ranks, batches);
  together(ranks, [&] {
    if (ranks.rank() == 0) name_step();
  });
  mark_.rows.insert(mark_.rows.end(), unnamed_.begin(), unnamed_.end());
  std::sort(mark_.rows.begin(), mark_.rows.end(),
            [](const auto& a, const auto& b) { return a.extent.offset < b.extent.offset; });
  mark_.step = model.clock.step;
  ++mark_.times;
}

std::string H5PartWriter::mark(core::Reductions& ranks) {
  std::string bytes;
  together(ranks, [&] {
    File(settings_.path, File::Mode::read).sync();
    if (ranks.rank() != 0) return;
    H5PartMark whole = mark_;
    whole.copy_tables(settings_.path);
    bytes = whole.bytes();
  });
  return bytes;
}

void H5PartWriter::finish(core::Reductions& ranks) {
  together(ranks, [&] {
    if (ranks.rank() == 0) {
      hdf5::Handle file = hdf5::open_file(settings_.path, hdf5::Access::change);
      hdf5::check(H5Ldelete(file, workshop, H5P_DEFAULT), "remove the temporary group");
      file.close("write '" + settings_.path + "'");
    }
  });
  together(ranks, [&] { File(settings_.path, File::Mode::read).sync(); });
}

}  // namespace mpm::io
