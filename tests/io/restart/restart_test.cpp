#include "io/restart/restart.hpp"

#include <array>
#include <bit>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "core/step/totals.hpp"
#include "io/output/file.hpp"
#include "io/output/hdf5.hpp"
#include "io/output/particle_order.hpp"
#include "io/restart/contents.hpp"
#include "tests/io/output/small_disk.hpp"
#include "tests/io/output/small_model.hpp"

using namespace mpm;
using namespace mpm::tests;
using core::Column;

namespace {

const io::RestartExtra an_extra{
    "<PeneBlast/>", {17, 3}, {{".sta", "12 3 4"}, {"_curv.dat", std::string("a\0b", 3)}, {".out", ""}}};

/// Body, number and columns of every particle of a brick.
std::vector<double> everything_in(const core::Model& model, const core::Brick& brick) {
  std::vector<double> all;
  for (const core::ConstParticleBlock& block : core::blocks_of(model, brick)) {
    all.push_back(block.body);
    all.push_back(block.used);
    for (const core::ConstParticle p : block)
      for (int c = 0; c < p.layout().columns(); ++c) all.push_back(p.nth(c));
  }
  return all;
}

bool same_particles(const core::Model& a, const core::Model& b) {
  if (a.bodies.size() != b.bodies.size() || a.grid->owned() != b.grid->owned()) return false;
  for (core::Slot s = 0; s < a.grid->owned(); ++s) {
    const core::Brick &x = a.grid->brick(s), &y = b.grid->brick(s);
    if (x.coord != y.coord || everything_in(a, x) != everything_in(b, y)) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("A restart file gives back the state to the last bit") {
  const Folder folder("restart");
  core::SoloCommunication solo;
  const core::Model model = small_model(solo);
  const std::string path = io::write_restart(folder.path(), "small", model, an_extra, solo);
  CHECK(path == folder / "small_120.pe");
  CHECK_FALSE(std::filesystem::exists(path + ".part"));

  core::Model copy = prepared_model(small_scene());
  const io::RestartResult result = io::read_restart(path, copy, solo);
  CHECK(same_particles(model, copy));
  CHECK(io::state_hash(copy, solo) == io::state_hash(model, solo));
  CHECK(io::restart_state_hash(path) == io::state_hash(model, solo));
  CHECK(copy.clock.step == 120);
  CHECK(copy.clock.time == 0.25);
  CHECK(copy.clock.dt == 1e-3);
  CHECK(copy.clock.lag == 0.5e-3);
  CHECK(copy.clock.first_lag == 0.625e-3);
  CHECK(copy.clock.critical_dt == 1.25e-3);
  CHECK(copy.clock.first_critical_dt == 1.5e-3);
  CHECK(copy.clock.looks.scale == 2e6);
  CHECK(copy.clock.looks.last == 1e-3);
  CHECK(copy.clock.looks.early == -2e-3);
  CHECK(copy.initial_energy == 1e6);
  CHECK(copy.next_identity == 601);
  CHECK(copy.ledger.external_work.value() == 1e20);
  // The small part is still there under the large one.
  core::ExactSum rest = copy.ledger.external_work;
  rest.add(-1e20);
  CHECK(rest.value() == 0.1);
  CHECK(copy.ledger.left_grid == 3);
  CHECK(copy.ledger.body_left == std::vector<std::int64_t>{3, 0, 0});
  CHECK(copy.ledger.body_eroded == std::vector<std::int64_t>{0, 5, 0});
  CHECK(copy.ledger.events.failed == 7);
  CHECK(result.extra.tracked == an_extra.tracked);
  CHECK(result.extra.marks == an_extra.marks);
  CHECK(result.notices.empty());
  CHECK(result.new_bodies.empty());

  const io::RestartScene scene = io::read_restart_scene(path);
  CHECK(scene.text == "<PeneBlast/>");
  CHECK(scene.path == "folder/small.xmp");
  CHECK(scene.job_name == "small");
}

TEST_CASE("The tiles of failed particles return, and follow the scene that is resumed") {
  const Folder folder("restart_failed");
  core::SoloCommunication solo;
  const auto with = small_scene(), without = small_scene();
  with->contact.enable = with->contact.failed_to_component = true;
  core::Model parted = prepared_model(with), whole = prepared_model(without);
  fill(parted, solo), fill(whole, solo);
  const auto tiles = [](const core::Model& model) {
    std::vector<std::array<std::int64_t, 4>> all;
    for (const core::Brick& brick : model.grid->bricks()) {
      for (const core::ParticleTile& t : brick.tiles)
        all.push_back({static_cast<std::int64_t>(core::key_of(brick.coord)), t.body, t.component, t.count});
    }
    return all;
  };
  CHECK(tiles(parted).size() > tiles(whole).size());
  CHECK(io::state_hash(parted, solo) != io::state_hash(whole, solo));
  const auto resumed = [&](const core::Model& from, const std::shared_ptr<core::Scene>& scene) {
    const std::string path = io::write_restart(folder.path(), "small", from, {}, solo);
    CHECK(io::restart_state_hash(path) == io::state_hash(from, solo));
    io::verify_restart(path, solo);
    core::Model to = prepared_model(scene);
    io::read_restart(path, to, solo);
    return to;
  };
  const core::Model same = resumed(parted, with);
  CHECK(tiles(same) == tiles(parted));
  CHECK(same_particles(same, parted));
  CHECK(io::state_hash(same, solo) == io::state_hash(parted, solo));
  CHECK(tiles(resumed(whole, with)) == tiles(parted));
  CHECK(tiles(resumed(parted, without)) == tiles(whole));
}

TEST_CASE("The motion of a rigid body, also with the forces that earlier versions stored") {
  const Folder folder("restart_rigid");
  core::SoloCommunication solo;
  core::Model model = small_model(solo);
  std::array<double, core::RigidState::size> state{};
  for (std::size_t i = 0; i < state.size(); ++i) state[i] = static_cast<double>(i + 1);
  model.bodies[1].rigid_state = std::bit_cast<core::RigidState>(state);
  const std::string path = io::write_restart(folder.path(), "small", model, an_extra, solo);
  const auto motion = [&] {
    return std::bit_cast<std::array<double, core::RigidState::size>>(
        io::read_contents(path).bodies.at(1).rigid.value());
  };
  CHECK(motion() == state);

  // 1 + 3 * 3 numbers, the inertia's 6, force and moment, contacts, and the symmetry.
  std::vector<double> earlier(state.begin(), state.end());
  earlier.insert(earlier.begin() + 16, 6, -1.0);
  {
    const io::hdf5::Handle file = io::hdf5::open_file(path, io::hdf5::Access::change);
    const io::hdf5::Handle body = io::hdf5::open_group(file, "bodies/1");
    io::hdf5::check(H5Ldelete(body, "rigid_motion", H5P_DEFAULT), "remove the motion");
    io::hdf5::write_all(body, "rigid_motion", std::span<const double>(earlier));
  }
  CHECK(motion() == state);
}

TEST_CASE("A state without particles can be stored too") {
  const Folder folder("restart_empty");
  core::SoloCommunication solo;
  const core::Model model = prepared_model(small_scene());
  const std::string path = io::write_restart(folder.path(), "small", model, {}, solo);
  core::Model copy = prepared_model(small_scene());
  io::read_restart(path, copy, solo);
  CHECK(copy.local_particles() == 0);
}

TEST_CASE("What a restart file shows to other programs") {
  const Folder folder("restart_hdf5");
  core::SoloCommunication solo;
  const std::string path = io::write_restart(folder.path(), "small", small_model(solo), an_extra, solo);
  const io::hdf5::Handle file = io::hdf5::open_file(path, io::hdf5::Access::read);
  CHECK(io::hdf5::read_string(file, "input_hash") == "0123456789abcdef");
  CHECK(io::hdf5::read_double(file, "time") == 0.25);
  CHECK(io::hdf5::read_all_bytes(file, "scene/text") == "<PeneBlast/>");
  const io::hdf5::Handle bar = io::hdf5::open_group(file, "bodies/0");
  CHECK(io::hdf5::read_string(bar, "name") == "bar");
  CHECK_THAT(io::hdf5::read_string(bar, "columns"),
             Catch::StartsWith("position_x position_y") && Catch::EndsWith("temperature failed"));
  CHECK(io::hdf5::shape_of(io::hdf5::open_dataset(bar, "particles")) == std::vector<hsize_t>{300, 21});
}

TEST_CASE("On another grid the particles are redistributed") {
  const Folder folder("restart_grid");
  core::SoloCommunication solo;
  const core::Model model = small_model(solo);
  const std::string path = io::write_restart(folder.path(), "small", model, an_extra, solo);
  SmallSetup larger;
  larger.cells = 20;
  core::Model copy = prepared_model(small_scene(), larger);
  const io::RestartResult result = io::read_restart(path, copy, solo);
  REQUIRE(result.notices.size() == 1);
  CHECK_THAT(result.notices[0], Catch::Contains("particles are redistributed"));
  CHECK(copy.local_particles() == 601);
  const core::Totals before = core::compute_totals(model, solo), after = core::compute_totals(copy, solo);
  CHECK(after.kinetic == Approx(before.kinetic).epsilon(1e-14));
  CHECK(after.bodies[0].max_temperature == before.bodies[0].max_temperature);
  CHECK(after.external_work == before.external_work);

  SmallSetup smaller;
  smaller.cells = 8;
  core::Model outside = prepared_model(small_scene(), smaller);
  CHECK_THROWS_WITH(
      io::read_restart(path, outside, solo),
      Catch::Contains("folder/small.xmp:7: <Grid>") &&
          Catch::Contains("particles of the restart file are outside this grid; enlarge the grid"));
}

TEST_CASE("A body may be deactivated; what it held is booked") {
  const Folder folder("restart_deactivated");
  core::SoloCommunication solo;
  const core::Model model = small_model(solo);
  const std::string path = io::write_restart(folder.path(), "small", model, an_extra, solo);
  auto scene = small_scene();
  scene->components[0].bodies[0].deactivated = true;
  core::Model copy = prepared_model(scene);
  const io::RestartResult result = io::read_restart(path, copy, solo);
  REQUIRE(result.notices.size() == 1);
  CHECK_THAT(result.notices[0], Catch::Contains("body 'bar' is deactivated: its 300 particles are removed"));
  CHECK(copy.local_particles() == 301);
  CHECK(copy.ledger.body_eroded == std::vector<std::int64_t>{5, 0});
  const core::Totals before = core::compute_totals(model, solo), after = core::compute_totals(copy, solo);
  CHECK(after.removed_kinetic == Approx(before.bodies[0].kinetic).epsilon(1e-13));
  CHECK(after.removed_internal == Approx(before.bodies[0].internal).epsilon(1e-11));
  CHECK(after.removed_mass == Approx(before.bodies[0].mass).epsilon(1e-13));
  CHECK(after.bodies[0].momentum == before.bodies[1].momentum);
}

TEST_CASE("A body may be added; it is left to the caller") {
  const Folder folder("restart_added");
  core::SoloCommunication solo;
  auto scene = small_scene();
  scene->components[0].bodies[0].deactivated = true;
  core::Model model = prepared_model(scene);
  fill(model, solo);
  const std::string path = io::write_restart(folder.path(), "small", model, {}, solo);
  core::Model copy = prepared_model(small_scene());
  const io::RestartResult result = io::read_restart(path, copy, solo);
  CHECK(result.new_bodies == std::vector<std::size_t>{0});
  CHECK(core::compute_totals(copy, solo).bodies[2].particles == 300);
}

TEST_CASE("A scene that does not fit is refused with every difference") {
  const Folder folder("restart_misfit");
  core::SoloCommunication solo;
  SmallSetup poor;
  poor.only_one_material = true;
  core::Model model = prepared_model(small_scene(), poor);
  fill(model, solo, poor);
  const std::string path = io::write_restart(folder.path(), "small", model, {}, solo);

  auto scene = small_scene();
  scene->components[1].bodies.pop_back();
  scene->materials[1].name = "ice";
  core::Model copy = prepared_model(scene);
  CHECK_THROWS_WITH(
      io::read_restart(path, copy, solo),
      Catch::Contains("<Body name=\"dust\">: the restart file has this body, but the scene does not; add it, "
                      "with Deactive=\"1\" to remove its particles") &&
          Catch::Contains(
              "folder/small.xmp:5: <Body name=\"bar\">: the scene needs state that the restart file does not "
              "have: effective_plastic_strain, temperature, failed; keep the material laws") &&
          Catch::Contains(
              "<Body name=\"wall <&> floor\">: its material is 'ice', but 'wax' in the restart file"));
}

TEST_CASE("A body with particles that becomes an operand is refused by what it is") {
  const Folder folder("restart_operand");
  core::SoloCommunication solo;
  core::Model model = prepared_model(small_scene());
  fill(model, solo);
  const std::string path = io::write_restart(folder.path(), "small", model, {}, solo);
  auto scene = small_scene();
  scene->components[0].bodies[0].for_bool = true;
  core::Model copy = prepared_model(scene);
  CHECK_THROWS_WITH(
      io::read_restart(path, copy, solo),
      Catch::Contains(
          "<Body name=\"bar\">: the restart file has particles of this body, but the scene makes it an "
          "operand of Bool bodies; remove ForBoolBody, or add Deactive=\"1\" to remove its particles"));
}

TEST_CASE("What is only shown may start at zero or go") {
  const Folder folder("restart_shown");
  core::SoloCommunication solo;
  SmallSetup with_speed;
  with_speed.shown = {Column::sound_speed};
  core::Model model = prepared_model(small_scene(), with_speed);
  fill(model, solo, with_speed);
  const std::string path = io::write_restart(folder.path(), "small", model, {}, solo);
  SmallSetup with_yield;
  with_yield.shown = {Column::yield_stress};
  core::Model copy = prepared_model(small_scene(), with_yield);
  const io::RestartResult result = io::read_restart(path, copy, solo);
  REQUIRE(result.notices.size() == 6);
  CHECK(result.notices[0] ==
        "body 'bar': yield_stress start at zero, since the restart file does not have them");
  CHECK(result.notices[1] == "body 'bar': sound_speed of the restart file are no longer needed");
  for (const core::ParticleBlock& block : core::blocks_of(copy)) {
    const core::ColumnLayout& layout = *block.layout;
    const core::Particle first = block.particle(0);
    const auto identity = static_cast<std::uint64_t>(first[Column::identity]);
    std::vector<double> expected = small_particle(layout, identity);
    for (int c = 0; c < core::column_count; ++c) {
      const auto column = static_cast<Column>(c);
      if (!layout.has(column)) continue;
      const double value = first[column];
      if (value != (column == Column::yield_stress ? 0 : expected[layout.index(column)])) {
        FAIL(core::name_of(column) << " of particle " << identity << " among " << block.used);
      }
    }
  }
}

TEST_CASE("A restart file becomes an .h5part file without its scene") {
  const Folder folder("restart_h5part");
  core::SoloCommunication solo;
  const core::Model model = small_model(solo);
  const std::string path = io::write_restart(folder.path(), "small", model, an_extra, solo);
  io::restart_to_h5part(path, folder / "small_120.h5part", io::variables_of({"kelv", "engi"}), true, solo);
  const io::hdf5::Handle file = io::hdf5::open_file(folder / "small_120.h5part", io::hdf5::Access::read);
  CHECK(io::hdf5::read_string(file, "job") == "small");
  const std::vector<double> engi = io::hdf5::read_all_double(file, "Step#0/engi");
  const std::vector<double> id = io::hdf5::read_all_double(file, "Step#0/id");
  const std::vector<double> kelv = io::hdf5::read_all_double(file, "Step#0/kelv");
  REQUIRE(engi.size() == 601);
  const core::ColumnLayout& layout = model.bodies[0].pool->layout();
  const auto p = small_particle(layout, static_cast<std::uint64_t>(id[9]));
  const auto at = [&](Column c) { return p[static_cast<std::size_t>(layout.offset(c) / 8)]; };
  CHECK(engi[9] == at(Column::internal_energy) * at(Column::mass) / 8.93e-3);
  CHECK(kelv[9] == at(Column::temperature));
}
