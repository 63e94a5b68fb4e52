#include "io/restart/contents.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <sstream>

#include <fmt/format.h>

#include "io/output/file.hpp"
#include "io/output/provenance.hpp"

namespace mpm::io {

using core::Ledger;

namespace {

struct SumName {
  const char* name;
  core::ExactSum Ledger::*sum;
};
constexpr SumName sum_names[] = {{"external_work", &Ledger::external_work},
                                 {"removed_mass", &Ledger::removed_mass},
                                 {"removed_kinetic", &Ledger::removed_kinetic},
                                 {"removed_internal", &Ledger::removed_internal},
                                 {"internal_lead", &Ledger::internal_lead}};
/// Only of scenes with contact: dissipated energy, heat of friction that is not of a pair, and per pair
/// impulse and heat of friction. In files of earlier versions all heat, and the impulses.
constexpr const char *contact_sums = "contact_pairs", *earlier_contact_sums = "contact";

std::vector<core::ExactSum> sums_of(const core::ContactRecord& contact) {
  if (contact.empty()) return {};
  std::vector<core::ExactSum> sums{contact.dissipated, contact.other_friction_heat};
  for (const core::ContactRecord::Pair& pair : contact.pairs) {
    sums.insert(sums.end(), pair.impulse.begin(), pair.impulse.end());
    sums.push_back(pair.friction_heat);
  }
  return sums;
}
constexpr std::size_t sums_of_pair = 4, earlier_sums_of_pair = 3;
core::ContactRecord contact_of(std::span<const core::ExactSum> sums, std::size_t of_pair = sums_of_pair) {
  core::ContactRecord contact;
  if (sums.size() < 2) return contact;
  contact.dissipated = sums[0];
  contact.other_friction_heat = sums[1];
  for (sums = sums.subspan(2); sums.size() >= of_pair; sums = sums.subspan(of_pair)) {
    core::ContactRecord::Pair& pair = contact.pairs.emplace_back();
    std::copy_n(sums.begin(), 3, pair.impulse.begin());
    if (of_pair == sums_of_pair) pair.friction_heat = sums[3];
  }
  return contact;
}

struct CountName {
  const char* name;
  std::int64_t Ledger::*count;
};
constexpr CountName count_names[] = {{"left_grid", &Ledger::left_grid},
                                     {"eroded", &Ledger::eroded},
                                     {"failed", &Ledger::failed},
                                     {"velocity_limited", &Ledger::velocity_limited},
                                     {"wide_domains", &Ledger::wide_domains},
                                     {"tangled_domains", &Ledger::tangled_domains}};

struct EventName {
  const char* name;
  long core::MaterialEvents::*count;
};
constexpr EventName event_names[] = {{"events_failed", &core::MaterialEvents::failed},
                                     {"events_negative_energy", &core::MaterialEvents::negative_energy},
                                     {"events_negative_volume", &core::MaterialEvents::negative_volume},
                                     {"events_volume_limited", &core::MaterialEvents::volume_limited},
                                     {"events_not_finite", &core::MaterialEvents::not_finite},
                                     {"events_undefined_root", &core::MaterialEvents::undefined_root},
                                     {"events_unresolved", &core::MaterialEvents::unresolved}};

struct TextName {
  const char* name;
  std::string core::HeaderInput::*text;
};
constexpr TextName header_names[] = {{"name", &core::HeaderInput::name},
                                     {"heading", &core::HeaderInput::heading},
                                     {"description", &core::HeaderInput::description},
                                     {"time_unit", &core::HeaderInput::time_unit},
                                     {"length_unit", &core::HeaderInput::length_unit},
                                     {"mass_unit", &core::HeaderInput::mass_unit}};

std::vector<core::Column> columns_of(const core::ColumnSet& set) {
  std::vector<core::Column> columns;
  for (int c = 0; c < core::column_count; ++c) {
    if (set.has(static_cast<core::Column>(c))) columns.push_back(static_cast<core::Column>(c));
  }
  return columns;
}

std::string names_of(const std::vector<core::Column>& columns) {
  std::string text;
  for (const core::Column c : columns) text.append(text.empty() ? "" : " ").append(core::name_of(c));
  return text;
}

std::vector<core::Column> columns_named(const std::string& text) {
  std::vector<core::Column> columns;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto found = std::find_if(core::column_table.begin(), core::column_table.end(),
                                    [&](const core::ColumnInfo& info) { return info.name == word; });
    if (found == core::column_table.end()) throw FileError("this program has no column '" + word + "'");
    columns.push_back(static_cast<core::Column>(found - core::column_table.begin()));
  }
  return columns;
}

std::int64_t entry(const std::vector<std::int64_t>& values, std::size_t i) {
  return i < values.size() ? values[i] : 0;
}

Ledger summed(const core::Model& model, std::vector<BodyRecord>& bodies, core::Reductions& ranks) {
  Ledger ledger = model.ledger;
  std::vector<core::ExactSum> sums;
  for (const auto& [name, sum] : sum_names) sums.push_back(ledger.*sum);
  std::vector<std::int64_t> counts;
  for (const auto& [name, count] : count_names) counts.push_back(ledger.*count);
  for (const auto& [name, count] : event_names) counts.push_back(ledger.events.*count);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    counts.push_back(entry(ledger.body_eroded, b));
    counts.push_back(entry(ledger.body_left, b));
  }
  // Also of a run without contact that goes on from one with it.
  const auto pairs = static_cast<std::size_t>(ranks.largest(double(ledger.contact.pairs.size())));
  if (model.scene->contact.enable || pairs > 0) {
    ledger.contact.pairs.resize(
        std::max(pairs, core::ContactPairs(core::component_count(*model.scene)).size()));
    for (const core::ExactSum& sum : sums_of(ledger.contact)) sums.push_back(sum);
  }
  const std::size_t of_ledger = sums.size();
  for (const core::Reaction& reaction : model.reactions)
    sums.insert(sums.end(), reaction.since_start.sums.begin(), reaction.since_start.sums.end());
  ranks.sum(std::span(sums));
  ranks.sum(std::span(counts));
  std::size_t s = 0, n = 0;
  for (const auto& [name, sum] : sum_names) {
    sums[s].normalise();
    ledger.*sum = sums[s++];
  }
  for (std::size_t i = s; i < sums.size(); ++i) sums[i].normalise();
  ledger.contact = contact_of(std::span(sums).subspan(s, of_ledger - s));
  auto next = sums.begin() + static_cast<std::ptrdiff_t>(of_ledger);
  for (const core::Reaction& reaction : model.reactions)
    for (core::ExactSum& sum : bodies[static_cast<std::size_t>(reaction.body)].reaction.emplace().sums)
      sum = *next++;
  for (const auto& [name, count] : count_names) ledger.*count = counts[n++];
  for (const auto& [name, count] : event_names) ledger.events.*count = static_cast<long>(counts[n++]);
  for (BodyRecord& b : bodies) {
    b.eroded = counts[n++];
    b.left = counts[n++];
  }
  return ledger;
}

void write_tiles(hid_t file, const std::vector<TileRecord>& tiles) {
  const std::array<hsize_t, 2> shape{tiles.size(), 4};
  const hdf5::Handle table = hdf5::create_dataset(file, "cohorts", H5T_STD_U64LE, shape);
  if (tiles.empty()) return;
  static_assert(sizeof(TileRecord) == 4 * sizeof(std::uint64_t));
  hdf5::check(H5Dwrite(table, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, tiles.data()),
              "write the tiles");
}

std::vector<TileRecord> read_tiles(hid_t file) {
  const hdf5::Handle table = hdf5::open_dataset(file, "cohorts");
  const std::vector<hsize_t> shape = hdf5::shape_of(table);
  if (shape.size() != 2 || shape[1] != 4) throw FileError("the table of tiles has the wrong shape");
  std::vector<TileRecord> tiles(shape[0]);
  if (tiles.empty()) return tiles;
  hdf5::check(H5Dread(table, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, tiles.data()),
              "read the tiles");
  return tiles;
}

std::vector<std::int64_t> limbs_of(std::span<const core::ExactSum> sums) {
  std::vector<std::int64_t> limbs;
  for (const core::ExactSum& sum : sums) limbs.insert(limbs.end(), sum.raw().begin(), sum.raw().end());
  return limbs;
}

std::vector<core::ExactSum> sums_from(const std::vector<std::int64_t>& limbs) {
  const std::size_t width = core::ExactSum{}.raw().size();
  if (limbs.size() % width != 0) throw FileError("an exact sum has the wrong number of limbs");
  std::vector<core::ExactSum> sums(limbs.size() / width);
  for (std::size_t i = 0; i < sums.size(); ++i)
    std::copy_n(limbs.begin() + static_cast<std::ptrdiff_t>(i * width), width, sums[i].raw().begin());
  return sums;
}

void write_ledger(hid_t file, const Ledger& ledger) {
  const hdf5::Handle group = hdf5::create_group(file, "books");
  for (const auto& [name, sum] : sum_names) hdf5::write_all(group, name, (ledger.*sum).raw());
  if (!ledger.contact.empty()) { hdf5::write_all(group, contact_sums, limbs_of(sums_of(ledger.contact))); }
  for (const auto& [name, count] : count_names) hdf5::write_attribute(group, name, ledger.*count);
  for (const auto& [name, count] : event_names)
    hdf5::write_attribute(group, name, std::int64_t{ledger.events.*count});
}

Ledger read_ledger(hid_t file) {
  const hdf5::Handle group = hdf5::open_group(file, "books");
  Ledger ledger;
  for (const auto& [name, sum] : sum_names) {
    if (!hdf5::has_link(group, name)) continue;  // in a file of an earlier version
    const std::vector<std::int64_t> limbs = hdf5::read_all_int64(group, name);
    const auto raw = (ledger.*sum).raw();
    if (limbs.size() != raw.size()) throw FileError("an exact sum has the wrong number of limbs");
    std::copy(limbs.begin(), limbs.end(), raw.begin());
  }
  if (hdf5::has_link(group, contact_sums))
    ledger.contact = contact_of(sums_from(hdf5::read_all_int64(group, contact_sums)));
  else if (hdf5::has_link(group, earlier_contact_sums))
    ledger.contact =
        contact_of(sums_from(hdf5::read_all_int64(group, earlier_contact_sums)), earlier_sums_of_pair);
  for (const auto& [name, count] : count_names) {
    // Files of earlier versions do not have all of them.
    if (hdf5::has_attribute(group, name)) ledger.*count = hdf5::read_int64(group, name);
  }
  for (const auto& [name, count] : event_names)
    ledger.events.*count = static_cast<long>(hdf5::read_int64(group, name));
  return ledger;
}

constexpr const char *rigid_motion = "rigid_motion", *reaction_sums = "reaction",
                     *face_forces = "face_forces";

void write_body(hid_t group, const BodyRecord& b) {
  hdf5::write_attribute(group, "name", b.name);
  hdf5::write_attribute(group, "component", b.component);
  hdf5::write_attribute(group, "material", b.material);
  hdf5::write_attribute(group, "component_number", std::int64_t{b.component_number});
  hdf5::write_attribute(group, "material_number", std::int64_t{b.material_number});
  hdf5::write_attribute(group, "reference_density", b.reference_density);
  hdf5::write_attribute(group, "no_output", std::int64_t{b.no_output});
  hdf5::write_attribute(group, "columns", names_of(b.columns));
  hdf5::write_attribute(group, "particles", b.particles);
  hdf5::write_attribute(group, "eroded", b.eroded);
  hdf5::write_attribute(group, "left", b.left);
  if (b.rigid) {
    const auto values = std::bit_cast<std::array<double, core::RigidState::size>>(*b.rigid);
    hdf5::write_all(group, rigid_motion, std::span<const double>(values));
  }
  if (b.reaction) hdf5::write_all(group, reaction_sums, limbs_of(b.reaction->sums));
  if (!b.face_forces.empty()) hdf5::write_all(group, face_forces, std::span<const double>(b.face_forces));
}

BodyRecord read_body(hid_t group) {
  BodyRecord b;
  b.name = hdf5::read_string(group, "name");
  b.component = hdf5::read_string(group, "component");
  b.material = hdf5::read_string(group, "material");
  b.component_number = static_cast<int>(hdf5::read_int64(group, "component_number"));
  b.material_number = static_cast<int>(hdf5::read_int64(group, "material_number"));
  b.reference_density = hdf5::read_double(group, "reference_density");
  b.no_output = hdf5::read_int64(group, "no_output") != 0;
  b.columns = columns_named(hdf5::read_string(group, "columns"));
  b.particles = hdf5::read_int64(group, "particles");
  b.eroded = hdf5::read_int64(group, "eroded");
  b.left = hdf5::read_int64(group, "left");
  if (hdf5::has_link(group, rigid_motion)) {
    std::vector<double> values = hdf5::read_all_double(group, rigid_motion);
    std::array<double, core::RigidState::size> state{};
    // Files of earlier versions have force and moment of the last step after the inertia.
    if (values.size() == state.size() + 6) values.erase(values.begin() + 16, values.begin() + 22);
    if (values.size() != state.size()) throw FileError("the motion of a rigid body has the wrong length");
    std::ranges::copy(values, state.begin());
    b.rigid = std::bit_cast<core::RigidState>(state);
  }
  if (hdf5::has_link(group, reaction_sums)) {
    const std::vector<core::ExactSum> sums = sums_from(hdf5::read_all_int64(group, reaction_sums));
    if (sums.size() != core::ReactionSums::count)
      throw FileError("the reaction of a body has the wrong length");
    std::ranges::copy(sums, b.reaction.emplace().sums.begin());
  }
  if (hdf5::has_link(group, face_forces)) b.face_forces = hdf5::read_all_double(group, face_forces);
  return b;
}

constexpr const char* bricks_of_nodes = "bricks_of_nodes";  ///< Site::node; absent in earlier versions

void write_grid(hid_t file, const core::GridGeometry& grid) {
  const hdf5::Handle group = hdf5::create_group(file, "grid");
  hdf5::write_all(group, "origin", std::array{grid.origin.x, grid.origin.y, grid.origin.z});
  hdf5::write_all(group, "cell", std::array{grid.cell.x, grid.cell.y, grid.cell.z});
  hdf5::write_all(group, "cells", std::span<const std::int64_t>(grid.cells));
  hdf5::write_attribute(group, bricks_of_nodes, std::int64_t{grid.site == core::Site::node});
}

core::GridGeometry read_grid(hid_t file) {
  const hdf5::Handle group = hdf5::open_group(file, "grid");
  const std::vector<double> origin = hdf5::read_all_double(group, "origin"),
                            cell = hdf5::read_all_double(group, "cell");
  const std::vector<std::int64_t> cells = hdf5::read_all_int64(group, "cells");
  if (origin.size() != 3 || cell.size() != 3 || cells.size() != 3)
    throw FileError("the grid is not three-dimensional");
  core::GridGeometry grid;
  if (hdf5::has_attribute(group, bricks_of_nodes) && hdf5::read_int64(group, bricks_of_nodes) != 0)
    grid.site = core::Site::node;
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    grid.origin[a] = origin[i];
    grid.cell[a] = cell[i];
    grid.inverse_cell[a] = 1 / cell[i];
    grid.cells[i] = cells[i];
  }
  return grid;
}

void write_run(hid_t file, const RestartContents& c) {
  hdf5::write_attribute(file, "step", c.clock.step);
  hdf5::write_attribute(file, "time", c.clock.time);
  hdf5::write_attribute(file, "dt", c.clock.dt);
  hdf5::write_attribute(file, "lag", c.clock.lag);
  hdf5::write_attribute(file, "first_lag", c.clock.first_lag);
  hdf5::write_attribute(file, "critical_dt", c.clock.critical_dt);
  hdf5::write_attribute(file, "first_critical_dt", c.clock.first_critical_dt);
  hdf5::write_attribute(file, "next_dt", c.clock.next_dt);
  hdf5::write_attribute(file, "heat_lead", c.clock.heat_lead);
  hdf5::write_attribute(file, "strain_lag", c.clock.strain_lag);
  hdf5::write_attribute(file, "scheme_since", c.clock.scheme_since);
  hdf5::write_attribute(file, "balance_scale", c.clock.looks.scale);
  hdf5::write_attribute(file, "balance_error", c.clock.looks.last);
  hdf5::write_attribute(file, "balance_early_error", c.clock.looks.early);
  hdf5::write_attribute(file, "initial_energy", c.initial_energy);
  hdf5::write_attribute(file, "next_identity", static_cast<std::int64_t>(c.next_identity));
}

void read_run(hid_t file, RestartContents& c) {
  c.clock.step = hdf5::read_int64(file, "step");
  c.clock.time = hdf5::read_double(file, "time");
  c.clock.dt = hdf5::read_double(file, "dt");
  // Not in files of earlier versions.
  const bool lags = hdf5::has_attribute(file, "lag");
  c.clock.lag = lags ? hdf5::read_double(file, "lag") : 0.5 * c.clock.dt;
  c.clock.first_lag = lags ? hdf5::read_double(file, "first_lag") : c.clock.lag;
  c.clock.critical_dt = hdf5::read_double(file, "critical_dt");
  c.clock.first_critical_dt = hdf5::read_double(file, "first_critical_dt");
  const auto or_zero = [file](const char* name) {
    return hdf5::has_attribute(file, name) ? hdf5::read_double(file, name) : 0.0;
  };
  c.clock.next_dt = or_zero("next_dt");
  c.clock.strain_lag = or_zero("strain_lag");
  c.clock.heat_lead = or_zero("heat_lead");
  if (hdf5::has_attribute(file, "scheme_since")) {
    c.clock.scheme_since = hdf5::read_int64(file, "scheme_since");
    c.clock.looks = {hdf5::read_double(file, "balance_scale"), hdf5::read_double(file, "balance_error"),
                     or_zero("balance_early_error")};
  }
  c.initial_energy = hdf5::read_double(file, "initial_energy");
  c.next_identity = static_cast<std::uint64_t>(hdf5::read_int64(file, "next_identity"));
}

void write_extra(hid_t file, const RestartExtra& extra) {
  const hdf5::Handle group = hdf5::create_group(file, "extra");
  hdf5::write_all(group, "tracked", std::span<const std::uint64_t>(extra.tracked));
  const hdf5::Handle marks = hdf5::create_group(group, "marks");
  std::string names;
  for (const auto& [name, bytes] : extra.marks) {
    hdf5::write_all(marks, name, std::string_view(bytes));
    names += name + '\n';
  }
  hdf5::write_all(group, "names", std::string_view(names));
}

RestartExtra read_extra(hid_t file) {
  const hdf5::Handle group = hdf5::open_group(file, "extra");
  RestartExtra extra;
  extra.tracked = hdf5::read_all_uint64(group, "tracked");
  if (!hdf5::has_link(group, "marks")) return extra;  // of format 1
  const hdf5::Handle marks = hdf5::open_group(group, "marks");
  std::istringstream names(hdf5::read_all_bytes(group, "names"));
  for (std::string name; std::getline(names, name);) extra.marks[name] = hdf5::read_all_bytes(marks, name);
  return extra;
}

/// Checks that the row counts of the tiles agree with those of the bodies.
void check_counts(const RestartContents& c) {
  std::vector<std::int64_t> particles(c.bodies.size());
  for (const TileRecord& r : c.tiles) {
    if (r.body < 0 || static_cast<std::size_t>(r.body) >= c.bodies.size())
      throw FileError("a tile refers to a body that does not exist");
    particles[static_cast<std::size_t>(r.body)] += static_cast<std::int64_t>(r.particles);
  }
  for (std::size_t b = 0; b < c.bodies.size(); ++b) {
    if (particles[b] != c.bodies[b].particles)
      throw FileError("the particles of the tiles of body '" + c.bodies[b].name +
                      "' do not add up to those of the body");
  }
}

}  // namespace

RestartContents contents_of(const core::Model& model, const RestartExtra& extra, const ParticleOrder& order,
                            core::Reductions& ranks) {
  const core::Scene& scene = *model.scene;
  RestartContents c;
  c.provenance = scene.provenance;
  c.header = scene.header;
  c.grid = model.grid->geometry();
  c.clock = model.clock;
  c.initial_energy = model.initial_energy;
  c.next_identity = model.next_identity;
  c.tiles = order.tiles;
  c.extra = extra;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const core::Body& b = model.bodies[i];
    c.bodies.push_back({b.name,
                        scene.components[static_cast<std::size_t>(b.component)].name,
                        scene.materials[static_cast<std::size_t>(b.material)].name,
                        b.component,
                        b.material,
                        b.model->reference_density(),
                        b.no_output,
                        columns_of(b.pool->layout().set()),
                        order.particles[i],
                        0,
                        0,
                        b.rigid_state,
                        {},
                        b.face_forces});
  }
  c.ledger = summed(model, c.bodies, ranks);
  return c;
}

std::string rows_name(std::size_t body) { return fmt::format("bodies/{}/particles", body); }

std::uint64_t expected_bytes(const RestartContents& c) {
  std::uint64_t bytes =
      262144 + c.extra.scene_text.size() + sizeof(TileRecord) * c.tiles.size() + 8 * c.extra.tracked.size();
  for (const auto& [name, mark] : c.extra.marks) bytes += 2048 + mark.size();
  bytes += sizeof(core::ExactSum) * (2 + sums_of_pair * c.ledger.contact.pairs.size());
  for (const BodyRecord& b : c.bodies)
    bytes += 16384 + (b.reaction ? 2048 + sizeof(core::ReactionSums) : 0) + 8 * b.face_forces.size() +
             8 * b.columns.size() * static_cast<std::uint64_t>(b.particles);
  return bytes;
}

std::vector<Extent> write_contents(const std::string& path, const RestartContents& c,
                                   const core::Scene& scene) {
  hdf5::Handle file = hdf5::create_file(path, guard_bytes(c.bodies.size()));
  std::vector<Extent> rows;
  {
    hdf5::write_attribute(file, provenance_of(scene));
    write_run(file, c);
    const hdf5::Handle text = hdf5::create_group(file, "scene");
    hdf5::write_attribute(text, "path", c.provenance.path);
    hdf5::write_attribute(text, "job", c.provenance.job_name);
    hdf5::write_attribute(text, "hash", c.provenance.hash);
    for (const auto& [name, member] : header_names) hdf5::write_attribute(text, name, c.header.*member);
    hdf5::write_all(text, "text", std::string_view(c.extra.scene_text));
    write_grid(file, c.grid);
    write_ledger(file, c.ledger);
    write_tiles(file, c.tiles);
    write_extra(file, c.extra);
    const hdf5::Handle bodies = hdf5::create_group(file, "bodies");
    hdf5::write_attribute(bodies, "bodies", static_cast<std::int64_t>(c.bodies.size()));
    for (std::size_t b = 0; b < c.bodies.size(); ++b) {
      const hdf5::Handle group = hdf5::create_group(bodies, std::to_string(b));
      write_body(group, c.bodies[b]);
      const std::array<hsize_t, 2> shape{static_cast<hsize_t>(c.bodies[b].particles),
                                         c.bodies[b].columns.size()};
      const hdf5::Handle data = hdf5::create_dataset(group, "particles", H5T_IEEE_F64LE, shape);
      if (shape[0] > 0) rows.push_back(hdf5::extent_of(data));
    }
  }
  file.close("write '" + path + "'");
  return rows;
}

RestartContents read_contents(const std::string& path) {
  RestartContents c;
  try {
    const hdf5::Handle file = hdf5::open_file(path, hdf5::Access::read);
    read_run(file, c);
    const hdf5::Handle text = hdf5::open_group(file, "scene");
    c.provenance = {hdf5::read_string(text, "path"), hdf5::read_string(text, "job"),
                    hdf5::read_string(text, "hash")};
    for (const auto& [name, member] : header_names) c.header.*member = hdf5::read_string(text, name);
    c.grid = read_grid(file);
    c.ledger = read_ledger(file);
    c.tiles = read_tiles(file);
    c.extra = read_extra(file);
    c.extra.scene_text = hdf5::read_all_bytes(text, "text");
    const hdf5::Handle bodies = hdf5::open_group(file, "bodies");
    const std::int64_t n = hdf5::read_int64(bodies, "bodies");
    for (std::int64_t b = 0; b < n; ++b)
      c.bodies.push_back(read_body(hdf5::open_group(bodies, std::to_string(b))));
    check_counts(c);
  } catch (const FileError& e) {
    throw FileError(fmt::format("cannot read the restart file '{}': {}", path, e.what()));
  }
  return c;
}

}  // namespace mpm::io
