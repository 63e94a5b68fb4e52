#include "io/output/vtu.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "io/output/file.hpp"
#include "io/output/particle_order.hpp"
#include "io/output/provenance.hpp"

namespace mpm::io {

namespace {

/// One array of a .vtu file.
struct Array {
  std::string name;
  std::string type;  ///< VTK name
  std::size_t bytes = 4;
  int components = 1;
  Variable first = Variable::count;  ///< the first component; count: the identity
};

std::vector<Array> point_arrays(const std::vector<Variable>& variables, bool double_precision) {
  const std::string real = double_precision ? "Float64" : "Float32";
  const std::size_t bytes = double_precision ? 8 : 4;
  std::vector<Array> arrays{{"velocity", real, bytes, 3, Variable::velocity_0},
                            {"id", "Int64", 8, 1, Variable::count},
                            {"body", "Int32", 4, 1, Variable::body}};
  for (const Variable v : variables) {
    if (v == Variable::body || (v >= Variable::velocity_0 && v <= Variable::velocity_2)) continue;
    const VariableInfo& info = info_of(v);
    arrays.push_back({std::string(info.name), info.integer ? "Int32" : real, info.integer ? 4 : bytes, 1, v});
  }
  return arrays;
}

Array position_array(bool double_precision) {
  return {"Position", double_precision ? "Float64" : "Float32", double_precision ? std::size_t{8} : 4, 3,
          Variable::posx};
}

std::string element(const char* tag, const Array& a) {
  return fmt::format("<{} type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"", tag, a.type, a.name,
                     a.components);
}

/// The particles of this rank for one file.
struct Piece {
  const core::Model* model = nullptr;
  std::vector<TilePlace> places;
  std::uint64_t particles = 0;
};

Piece piece_of(const core::Model& model, const std::vector<std::size_t>& bodies) {
  Piece piece{&model, {}, 0};
  std::vector<bool> wanted(model.bodies.size());
  for (const std::size_t b : bodies) wanted[b] = true;
  std::vector<std::pair<std::pair<std::int64_t, core::BrickKey>, TilePlace>> order;
  for (core::Slot s = 0; s < model.grid->owned(); ++s) {
    const core::Brick& brick = model.grid->brick(s);
    for (std::size_t c = 0; c < brick.tiles.size(); ++c) {
      const core::ParticleTile& tile = brick.tiles[c];
      if (!wanted[static_cast<std::size_t>(tile.body)]) continue;
      order.push_back({{tile.body, core::key_of(brick.coord)}, {s, static_cast<int>(c), 0}});
      piece.particles += tile.count;
    }
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& entry : order) piece.places.push_back(entry.second);
  return piece;
}

/// Appended data: each array is its length in bytes, then its values, buffered into larger writes.
class Appended {
 public:
  explicit Appended(File& file) : file_(file) {}
  template <class T>
  void put(T value) {
    buffer_.append(reinterpret_cast<const char*>(&value), sizeof value);
    if (buffer_.size() >= std::size_t{1} << 20) flush();
  }
  void flush() {
    file_.write(buffer_);
    buffer_.clear();
  }

 private:
  File& file_;
  std::string buffer_;
};

/// Adds the number of clipped values to `cut`.
template <class T>
void put_values(const Piece& piece, const Array& array, Appended& out, std::int64_t& cut) {
  for (const TilePlace& place : piece.places) {
    for (const core::ConstParticleBlock& block : blocks_at(*piece.model, place)) {
      const BodyFacts facts = facts_of(*piece.model, static_cast<std::size_t>(block.body));
      for (const core::ConstParticle p : block) {
        if (array.first == Variable::count) {
          out.put(static_cast<T>(p[core::Column::identity]));
          continue;
        }
        for (int c = 0; c < array.components; ++c) {
          const auto v = static_cast<Variable>(static_cast<int>(array.first) + c);
          out.put(narrowed<T>(evaluate(v, p, facts), cut));
        }
      }
    }
  }
}

void put_array(const Piece& piece, const Array& array, Appended& out, std::int64_t& cut) {
  out.put(piece.particles * array.bytes * static_cast<std::uint64_t>(array.components));
  if (array.type == "Float32") put_values<float>(piece, array, out, cut);
  if (array.type == "Float64") put_values<double>(piece, array, out, cut);
  if (array.type == "Int32") put_values<std::int32_t>(piece, array, out, cut);
  if (array.type == "Int64") put_values<std::int64_t>(piece, array, out, cut);
}

std::string vtk_head(const char* type, const core::Scene& scene) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + to_xml_comment(provenance_of(scene)) +
         fmt::format(
             "<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n",
             type);
}

std::string time_field(double time) {
  return fmt::format(
      "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">{:.17g}"
      "</DataArray>\n</FieldData>\n",
      time);
}

/// Cells are vertices: cell i is point i. Adds the numbers of clipped values to `cut`, by array, position
/// first.
void write_piece(const std::string& path, const Piece& piece, const Array& position,
                 const std::vector<Array>& arrays, std::vector<std::int64_t>& cut) {
  std::uint64_t offset = 0;
  const auto declare = [&](const Array& a) {
    const std::string text =
        fmt::format("{} format=\"appended\" offset=\"{}\"/>\n", element("DataArray", a), offset);
    offset += 8 + piece.particles * a.bytes * static_cast<std::uint64_t>(a.components);
    return text;
  };
  std::string head =
      vtk_head("UnstructuredGrid", *piece.model->scene) + "<UnstructuredGrid>\n" +
      time_field(piece.model->clock.time) +
      fmt::format("<Piece NumberOfPoints=\"{0}\" NumberOfCells=\"{0}\">\n<Points>\n", piece.particles);
  head += declare(position) + "</Points>\n<PointData Vectors=\"velocity\">\n";
  for (const Array& a : arrays) head += declare(a);
  head += "</PointData>\n<Cells>\n";
  head += declare({"connectivity", "Int64", 8, 1, Variable::count});
  head += declare({"offsets", "Int64", 8, 1, Variable::count});
  head += declare({"types", "UInt8", 1, 1, Variable::count});
  head += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";

  File file(path, File::Mode::write_anew);
  file.write(head);
  Appended out(file);
  put_array(piece, position, out, cut[0]);
  for (std::size_t a = 0; a < arrays.size(); ++a) put_array(piece, arrays[a], out, cut[a + 1]);
  constexpr std::uint8_t vertex = 1;
  out.put(8 * piece.particles);
  for (std::uint64_t i = 0; i < piece.particles; ++i) out.put(static_cast<std::int64_t>(i));
  out.put(8 * piece.particles);
  for (std::uint64_t i = 0; i < piece.particles; ++i) out.put(static_cast<std::int64_t>(i + 1));
  out.put(piece.particles);
  for (std::uint64_t i = 0; i < piece.particles; ++i) out.put(vertex);
  out.flush();
  file.write("\n</AppendedData>\n</VTKFile>\n");
  file.close();
}

std::string piece_name(const std::string& stem, int rank) { return fmt::format("{}_{}.vtu", stem, rank); }

std::string index_of_pieces(const std::string& stem, const std::vector<int>& ranks, const Array& position,
                            const std::vector<Array>& arrays, const core::Model& model) {
  std::string text = vtk_head("PUnstructuredGrid", *model.scene) + "<PUnstructuredGrid GhostLevel=\"0\">\n" +
                     time_field(model.clock.time);
  text +=
      "<PPoints>\n" + element("PDataArray", position) + "/>\n</PPoints>\n<PPointData Vectors=\"velocity\">\n";
  for (const Array& a : arrays) text += element("PDataArray", a) + "/>\n";
  text += "</PPointData>\n";
  for (const int r : ranks) text += fmt::format("<Piece Source=\"{}\"/>\n", xml_escaped(piece_name(stem, r)));
  return text + "</PUnstructuredGrid>\n</VTKFile>\n";
}

/// Names of the bodies in file names: their own where these are valid, unique, and short enough for a file
/// system's 255 bytes with the job, the step, the rank and the ending.
std::vector<std::string> file_names_of(const core::Model& model, const std::string& job) {
  constexpr std::size_t most = 255 - 35;
  std::vector<std::string> names;
  for (const core::Body& body : model.bodies) names.push_back(body.name);
  return distinct_names(names, "body", most - std::min(job.size(), most_bytes_of_job));
}

/// Inverse of xml_escaped().
std::string xml_plain(std::string text) {
  constexpr std::pair<std::string_view, char> entities[] = {
      {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&amp;", '&'}};
  for (const auto& [entity, plain] : entities) {
    for (std::size_t at = text.find(entity); at != std::string::npos; at = text.find(entity, at + 1))
      text.replace(at, entity.size(), 1, plain);
  }
  return text;
}

std::string attribute_of(const std::string& line, const std::string& name) {
  const std::string start = name + "=\"";
  const std::size_t at = line.find(start);
  if (at == std::string::npos) return {};
  const std::size_t end = line.find('"', at + start.size());
  return end == std::string::npos ? std::string() : line.substr(at + start.size(), end - at - start.size());
}

}  // namespace

VtuWriter::VtuWriter(Settings settings, const core::Model& model, core::Reductions& ranks)
    : settings_(std::move(settings)) {
  if (settings_.continue_from && !settings_.continue_from->empty()) read_mark(*settings_.continue_from);
  together(ranks, [&] {
    if (ranks.rank() != 0) return;
    make_folder(settings_.folder + "/" + settings_.job + "_vtu");
    const std::size_t listed = entries_.size();
    std::erase_if(entries_, [&](const Entry& e) {
      return !std::filesystem::exists(settings_.folder + "/" + xml_plain(e.file));
    });
    if (entries_.size() < listed) {
      notice_ = fmt::format("{} of the {} files that '{}/{}.pvd' listed are missing",
                            listed - entries_.size(), listed, settings_.folder, settings_.job);
    }
    write_collection(*model.scene);
  });
}

/// The step of the last time, a line, then the list.
void VtuWriter::read_mark(const std::string& mark) {
  last_step_ = std::strtoll(mark.c_str(), nullptr, 10);
  for (std::size_t at = mark.find("<DataSet "); at != std::string::npos;
       at = mark.find("<DataSet ", at + 1)) {
    const std::string line = mark.substr(at, mark.find("/>", at) - at);
    entries_.push_back({std::strtod(attribute_of(line, "timestep").c_str(), nullptr),
                        std::atoi(attribute_of(line, "part").c_str()), attribute_of(line, "name"),
                        attribute_of(line, "file")});
  }
}

std::string VtuWriter::list() const {
  std::string text;
  for (const Entry& e : entries_) {
    text += fmt::format("<DataSet timestep=\"{:.17g}\" part=\"{}\" name=\"{}\" file=\"{}\"/>\n", e.time,
                        e.part, e.name, e.file);
  }
  return text;
}

std::string VtuWriter::mark() const { return fmt::format("{}\n{}", last_step_, list()); }

void VtuWriter::write_collection(const core::Scene& scene) const {
  const std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + to_xml_comment(provenance_of(scene)) +
      "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
  replace_file(settings_.folder + "/" + settings_.job + ".pvd",
               text + list() + "</Collection>\n</VTKFile>\n");
}

void VtuWriter::sync(core::Reductions& ranks) {
  together(ranks, [&] {
    for (const std::string& path : unsynced_) File(path, File::Mode::read).sync();
    unsynced_.clear();
  });
}

void VtuWriter::write_set(const std::string& stem, const std::string& name,
                          const std::vector<std::size_t>& bodies, const core::Model& model,
                          core::Reductions& ranks, int part) {
  const std::string folder = settings_.job + "_vtu";
  const std::string path = settings_.folder + "/" + folder + "/";
  const Array position = position_array(settings_.double_precision);
  const std::vector<Array> arrays = point_arrays(settings_.variables, settings_.double_precision);
  const Piece piece = piece_of(model, bodies);

  std::vector<std::int64_t> on_rank(static_cast<std::size_t>(ranks.size()));
  on_rank[static_cast<std::size_t>(ranks.rank())] = static_cast<std::int64_t>(piece.particles);
  ranks.sum(std::span(on_rank));
  std::vector<int> with_piece;
  for (int r = 0; r < ranks.size(); ++r) {
    if (on_rank[static_cast<std::size_t>(r)] > 0) with_piece.push_back(r);
  }
  if (with_piece.empty()) with_piece.push_back(0);  // viewers require at least one piece

  together(ranks, [&] {
    if (std::ranges::find(with_piece, ranks.rank()) == with_piece.end()) return;
    const std::string name_of_mine = path + piece_name(stem, ranks.rank());
    try {
      write_piece(name_of_mine, piece, position, arrays, cut_now_);
      unsynced_.push_back(name_of_mine);
    } catch (const FileError&) {
      remove_file(name_of_mine);
      throw;
    }
  });
  together(ranks, [&] {
    if (ranks.rank() != 0) return;
    replace_file(path + stem + ".pvtu", index_of_pieces(stem, with_piece, position, arrays, model));
    entries_.push_back(
        {model.clock.time, part, xml_escaped(name), xml_escaped(folder + "/" + stem + ".pvtu")});
  });
}

void VtuWriter::write(const core::Model& model, core::Reductions& ranks) {
  std::vector<std::string> names{"position"};
  for (const Array& a : point_arrays(settings_.variables, settings_.double_precision))
    names.push_back(a.name);
  cut_now_.assign(names.size(), 0);
  std::vector<std::size_t> written;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (!model.bodies[b].no_output) written.push_back(b);
  }
  if (!settings_.per_body) {
    write_set(fmt::format("{}_{}", settings_.job, model.clock.step), "all bodies", written, model, ranks, 0);
  } else {
    const std::vector<std::string> bodies = file_names_of(model, settings_.job);
    for (const std::size_t b : written) {
      const std::string stem = fmt::format("{}_{}_{}", settings_.job, bodies[b], model.clock.step);
      write_set(stem, model.bodies[b].name, {b}, model, ranks, static_cast<int>(b));
    }
  }
  last_step_ = model.clock.step;
  together(ranks, [&] {
    if (ranks.rank() == 0) write_collection(*model.scene);
  });
  warning_ = cut_.warning(settings_.folder + "/" + settings_.job + ".pvd", model.clock.step, names,
                          std::move(cut_now_), ranks);
}

}  // namespace mpm::io
