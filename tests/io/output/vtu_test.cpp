#include "io/output/vtu.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>

#include <catch2/catch.hpp>
#include <libxml/parser.h>

#include "io/output/file.hpp"
#include "tests/io/output/small_model.hpp"

using namespace mpm;
using namespace mpm::tests;

namespace {

/// A .vtu file: its XML, with the appended bytes taken out, and those bytes.
struct Vtu {
  std::string appended;
  xmlDocPtr document = nullptr;

  explicit Vtu(const std::string& path) {
    std::string text = io::read_file(path);
    if (const std::size_t begin = text.find("<AppendedData encoding=\"raw\">"); begin != std::string::npos) {
      const std::size_t first = text.find('_', begin) + 1, last = text.rfind("\n</AppendedData>");
      appended = text.substr(first, last - first);
      text.erase(first, last - first);
    }
    document =
        xmlReadMemory(text.data(), static_cast<int>(text.size()), path.c_str(), nullptr, XML_PARSE_NONET);
  }
  ~Vtu() { xmlFreeDoc(document); }
  Vtu(const Vtu&) = delete;
  Vtu& operator=(const Vtu&) = delete;

  xmlNodePtr find(const std::string& tag, const std::string& name = {}) const {
    return find(xmlDocGetRootElement(document), tag, name);
  }
  static std::string attribute(xmlNodePtr node, const char* name) {
    xmlChar* value = xmlGetProp(node, reinterpret_cast<const xmlChar*>(name));
    const std::string text = value == nullptr ? "" : reinterpret_cast<const char*>(value);
    xmlFree(value);
    return text;
  }
  template <class T>
  std::vector<T> values(const std::string& name) const {
    const std::size_t offset = std::stoul(attribute(find("DataArray", name), "offset"));
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, appended.data() + offset, sizeof bytes);
    std::vector<T> out(bytes / sizeof(T));
    if (!out.empty()) std::memcpy(out.data(), appended.data() + offset + sizeof bytes, bytes);
    return out;
  }
  int count(const std::string& tag) const { return count(xmlDocGetRootElement(document), tag); }

 private:
  static xmlNodePtr find(xmlNodePtr node, const std::string& tag, const std::string& name) {
    for (; node != nullptr; node = node->next) {
      if (reinterpret_cast<const char*>(node->name) == tag &&
          (name.empty() || attribute(node, "Name") == name))
        return node;
      if (xmlNodePtr found = find(node->children, tag, name)) return found;
    }
    return nullptr;
  }
  static int count(xmlNodePtr node, const std::string& tag) {
    int n = 0;
    for (; node != nullptr; node = node->next) {
      n += (reinterpret_cast<const char*>(node->name) == tag) + count(node->children, tag);
    }
    return n;
  }
};

}  // namespace

TEST_CASE("What a 32-bit real does not hold is cut in grids, too") {
  const Folder folder("vtu_cut");
  core::SoloCommunication solo;
  core::Model model = small_model(solo);
  for (core::Brick& brick : model.grid->bricks()) {
    for (core::ParticleTile& tile : brick.tiles) {
      if (tile.body != 0) continue;
      core::BlockPool& pool = *model.bodies[0].pool;
      for (const core::BlockIndex b : tile.blocks)
        std::fill_n(pool.block(b) + pool.layout().offset(core::Column::pressure), core::block_lanes, 1e39);
    }
  }
  io::VtuWriter writer({folder.path(), "small", false, io::variables_of({"pres"}), false, {}}, model, solo);
  writer.write(model, solo);
  CHECK_THAT(writer.warning(), Catch::Contains("small.pvd") && Catch::Contains("300 value(s) of pres"));
  const Vtu piece(folder / "small_vtu/small_120_0.vtu");
  const auto pressure = piece.values<float>("pres");
  CHECK(std::count(pressure.begin(), pressure.end(), std::numeric_limits<float>::max()) == 300);
}

TEST_CASE("Failed particles in a component of their own are written once, as component 0") {
  const Folder folder("vtu_failed");
  core::SoloCommunication solo;
  const auto scene = small_scene();
  scene->contact.enable = scene->contact.failed_to_component = true;
  core::Model model = prepared_model(scene);
  fill(model, solo);
  io::VtuWriter writer({folder.path(), "small", false, io::variables_of({"com", "fail"}), false, {}}, model,
                       solo);
  writer.write(model, solo);
  const Vtu piece(folder / "small_vtu/small_120_0.vtu");
  auto id = piece.values<std::int64_t>("id");
  const auto component = piece.values<std::int32_t>("com"), failed = piece.values<std::int32_t>("fail");
  REQUIRE((id.size() == 601 && component.size() == 601 && failed.size() == 601));
  for (std::size_t i = 0; i < 601; ++i) CHECK((component[i] == 0) == (failed[i] == 1));
  CHECK(std::count(component.begin(), component.end(), 0) > 20);
  std::sort(id.begin(), id.end());
  for (std::size_t i = 0; i < 601; ++i) CHECK(id[i] == static_cast<std::int64_t>(i));
}

TEST_CASE("One set of grids per time: well-formed, complete, listed") {
  const Folder folder("vtu");
  core::SoloCommunication solo;
  core::Model model = small_model(solo);
  io::VtuWriter writer(
      {folder.path(), "small", false, io::variables_of({"seqv", "mat", "velocity_0"}), false, {}}, model,
      solo);
  writer.write(model, solo);

  const Vtu index(folder / "small_vtu/small_120.pvtu");
  REQUIRE(index.document != nullptr);
  CHECK(index.count("Piece") == 1);
  CHECK(Vtu::attribute(index.find("Piece"), "Source") == "small_120_0.vtu");
  CHECK(index.count("PDataArray") == 6);

  const Vtu piece(folder / "small_vtu/small_120_0.vtu");
  REQUIRE(piece.document != nullptr);
  CHECK(Vtu::attribute(piece.find("Piece"), "NumberOfPoints") == "601");
  CHECK(Vtu::attribute(piece.find("Piece"), "NumberOfCells") == "601");
  CHECK(Vtu::attribute(piece.find("DataArray", "seqv"), "type") == "Float32");
  CHECK(Vtu::attribute(piece.find("DataArray", "mat"), "type") == "Int32");
  CHECK(piece.find("DataArray", "velocity_0") == nullptr);
  const auto x = piece.values<float>("Position"), v = piece.values<float>("velocity");
  const auto id = piece.values<std::int64_t>("id");
  const auto cells = piece.values<std::int64_t>("connectivity"), ends = piece.values<std::int64_t>("offsets");
  const auto types = piece.values<std::uint8_t>("types");
  REQUIRE(x.size() == 3 * 601);
  REQUIRE(v.size() == 3 * 601);
  REQUIRE(id.size() == 601);
  CHECK((cells.size() == 601 && cells.back() == 600));
  CHECK((ends.size() == 601 && ends.back() == 601));
  CHECK((types.size() == 601 && types.back() == 1));
  CHECK(piece.values<float>("seqv").size() == 601);
  // After the last array there is nothing.
  CHECK(std::stoul(Vtu::attribute(piece.find("DataArray", "types"), "offset")) + 8 + 601 ==
        piece.appended.size());
  const std::size_t i = 77;
  const std::vector<double> p = small_particle(
      model.bodies[static_cast<std::size_t>(id[i] / 300)].pool->layout(), static_cast<std::uint64_t>(id[i]));
  for (std::size_t a = 0; a < 3; ++a) {
    CHECK(x[3 * i + a] == static_cast<float>(p[a]));
    CHECK(v[3 * i + a] == static_cast<float>(p[3 + a]));
  }

  const Vtu list(folder / "small.pvd");
  REQUIRE(list.document != nullptr);
  CHECK(Vtu::attribute(list.find("DataSet"), "file") == "small_vtu/small_120.pvtu");
  CHECK(Vtu::attribute(list.find("DataSet"), "timestep") == "0.25");
}

TEST_CASE("Files of bodies with long names") {
  const Folder folder("vtu_long");
  core::SoloCommunication solo;
  core::Model model = small_model(solo);
  const std::string job(180, 'j');
  model.bodies[0].name = std::string(400, 'b');
  io::VtuWriter writer({folder.path(), job, true, io::variables_of({"seqv"}), false, {}}, model, solo);
  writer.write(model, solo);
  const std::string short_name = std::string(34, 'b') + "_body0";
  CHECK(std::filesystem::exists(folder / (job + "_vtu/" + job + "_" + short_name + "_120_0.vtu")));
}

TEST_CASE("One set of grids per body, but for those without output") {
  const Folder folder("vtu_bodies");
  core::SoloCommunication solo;
  core::Model model = small_model(solo);
  model.bodies[2].no_output = true;
  io::VtuWriter({folder.path(), "small", true, {}, true, {}}, model, solo).write(model, solo);
  const Vtu list(folder / "small.pvd");
  REQUIRE(list.document != nullptr);
  CHECK(list.count("DataSet") == 2);
  const std::string second = "small_vtu/small_wall__&__floor_120";
  CHECK(std::filesystem::exists(folder / (second + ".pvtu")));
  const Vtu piece(folder / (second + "_0.vtu"));
  REQUIRE(piece.document != nullptr);
  const auto body = piece.values<std::int32_t>("body");
  CHECK(body == std::vector<std::int32_t>(300, 1));
  CHECK(piece.values<double>("Position").size() == 900);
}

TEST_CASE("Bodies whose names look alike in file names have files of their own") {
  const Folder folder("vtu_names");
  core::SoloCommunication solo;
  core::Model model = small_model(solo);
  model.bodies[0].name = "a/b";
  model.bodies[1].name = "a b";
  io::VtuWriter({folder.path(), "small", true, {}, false, {}}, model, solo).write(model, solo);
  CHECK(std::filesystem::exists(folder / "small_vtu/small_a_b_body0_120.pvtu"));
  CHECK(std::filesystem::exists(folder / "small_vtu/small_a_b_body1_120.pvtu"));
}

TEST_CASE("Without any particles there is one empty piece") {
  const Folder folder("vtu_empty");
  core::SoloCommunication solo;
  core::Model model = prepared_model(small_scene());
  io::VtuWriter({folder.path(), "small", false, {}, false, {}}, model, solo).write(model, solo);
  const Vtu piece(folder / "small_vtu/small_0_0.vtu");
  REQUIRE(piece.document != nullptr);
  CHECK(Vtu::attribute(piece.find("Piece"), "NumberOfPoints") == "0");
}

TEST_CASE("The list of a run that goes on is that of its restart file") {
  const Folder folder("vtu_continue");
  core::SoloCommunication solo;
  core::Model model = small_model(solo);
  model.scene = std::make_shared<core::Scene>([&] {
    core::Scene scene = *model.scene;
    scene.provenance.job_name = "a&b";
    return scene;
  }());
  std::string mark;
  {
    io::VtuWriter writer({folder.path(), "a&b", true, {}, false, {}}, model, solo);
    for (const double t : {0.0, 1.0 / 3, 1.0}) {
      model.clock.time = t;
      ++model.clock.step;
      writer.write(model, solo);
      writer.sync(solo);
      if (t < 0.5) mark = writer.mark();
    }
  }
  const auto go_on = [&] {
    return io::VtuWriter({folder.path(), "a&b", true, {}, false, mark}, model, solo);
  };
  // Whatever the list says by now.
  std::ofstream(folder / "a&b.pvd") << "damaged";
  CHECK(go_on().notice().empty());
  CHECK(go_on().last_step() == 122);
  const std::string list = io::read_file(folder / "a&b.pvd");
  CHECK(Vtu(folder / "a&b.pvd").count("DataSet") == 6);
  CHECK_THAT(list, Catch::Contains("0.33333333333333331"));
  CHECK_THAT(list, Catch::Contains("name=\"wall &lt;&amp;&gt; floor\""));
  CHECK_FALSE(std::filesystem::exists(folder / "a&b.pvd.part"));
  std::filesystem::remove(folder / "a&b_vtu/a&b_bar_121.pvtu");
  CHECK_THAT(go_on().notice(), Catch::Contains("1 of the 6 files that"));
  CHECK(Vtu(folder / "a&b.pvd").count("DataSet") == 5);
}
