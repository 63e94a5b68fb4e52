#include "io/input/reader.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "core/step/scheme_change.hpp"
#include "io/input/build.hpp"
#include "io/input/checker.hpp"
#include "io/input/document.hpp"
#include "io/input/file_access.hpp"
#include "io/input/idle.hpp"
#include "io/input/library.hpp"
#include "io/input/shape_notes.hpp"
#include "io/input/specification.hpp"
#include "io/input/text.hpp"
#include "io/input/user_specification.hpp"
#include "io/output/provenance.hpp"

namespace mpm::io {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, std::string message) {
  throw core::InputErrors(core::SourceLocation{file.string(), 0}, {}, std::move(message));
}

/// The intended name where an attribute occurs twice, if the language defines one.
std::string meant_by_repeated(const ElementSpec& spec, std::string_view name) {
  for (const AttributeSpec& a : spec.attributes)
    if (a.name == name && !a.twice.empty()) return a.twice;
  for (const ElementSpec& child : spec.children)
    if (std::string found = meant_by_repeated(child, name); !found.empty()) return found;
  return {};
}

void report(const XmlError& error, const ElementSpec& root, Diagnostics& diagnostics) {
  std::string message = error.message;
  if (const std::string meant = meant_by_repeated(root, error.repeated_attribute); !meant.empty())
    message += fmt::format("; the second is spelled '{}'", meant);
  diagnostics.add(error.line, {}, std::move(message));
}

core::Scene build(const Node& root, const BuildContext& context) {
  core::Scene scene;
  scene.header = build_header(root);
  scene.materials = build_materials(root, context);
  scene.frictions = build_frictions(root, scene.materials, context);
  scene.work_planes = build_work_planes(root, context);
  scene.grid = build_grid(root, context);
  scene.contact = build_contact(root);
  scene.solution = build_solution(root, context);
  scene.components = build_components(root, scene, context);
  check_shapes(root, scene, context);
  scene.detonations = build_detonations(root, context);
  check_method(root, scene, context);
  check_contact(root, scene, context);
  check_implicit(root, scene, context);
  scene.output = build_output(root, scene, context);
  scene.decomposition = build_decomposition(root, context);
  return scene;
}

}  // namespace

std::filesystem::path find_input(const std::filesystem::path& job) {
  if (job.empty()) refuse({}, "the name of the job is empty: give an input file, Job.xmp");
  std::error_code ignored;
  std::filesystem::path with_extension = job;
  with_extension += ".xmp";
  const bool named_fully = job.extension() == ".xmp";
  if (!named_fully && job.has_filename() && std::filesystem::exists(with_extension, ignored))
    return with_extension;
  if (std::filesystem::exists(job, ignored)) return job;
  if (named_fully) refuse(job, "no such file");
  refuse(job, fmt::format("no such file, nor {}", with_extension.string()));
}

std::string read_bytes(const std::filesystem::path& file) {
  if (const std::string wrong = why_unreadable(file); !wrong.empty()) refuse(file, wrong);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> opened(std::fopen(file.c_str(), "rb"), std::fclose);
  if (!opened) refuse(file, std::strerror(errno));
  std::string bytes;
  constexpr std::size_t piece = 1 << 20;
  for (std::size_t count = piece; count == piece;) {
    const std::size_t held = bytes.size();
    bytes.resize(held + piece);
    count = std::fread(bytes.data() + held, 1, piece, opened.get());
    bytes.resize(held + count);
    if (bytes.size() > largest_document) break;  // parse_scene reports it
  }
  if (std::ferror(opened.get())) refuse(file, std::strerror(errno));
  return bytes;
}

core::Scene parse_scene(std::string_view bytes, const std::filesystem::path& file,
                        const core::Catalogue& catalogue, const ReadOptions& options) {
  return parse_scene(bytes, file, language(catalogue), options);
}

core::Scene parse_scene(std::string_view bytes, const std::filesystem::path& file, const ElementSpec& root,
                        const ReadOptions& options) {
  Diagnostics diagnostics(file.string());
  std::optional<XmlError> error;
  Document document = parse_document(bytes, error);
  if (error) {
    report(*error, root, diagnostics);
  } else {
    fill_in_from_library(document, library(), diagnostics);
    check(document, root, options.accept_later, diagnostics);
    Diagnostics by_users(file.string());
    if (options.users) check(document, options.users->root, true, by_users);
    diagnostics.merge(by_users);
  }
  core::Scene scene;
  if (!error && document.elements().front().name == root.name)
    scene = build(Node(document, 0, root, {}), {diagnostics, file.parent_path(), options.check_files});
  const std::filesystem::path name = file.extension() == ".xmp" ? file.stem() : file.filename();
  if (name.empty() || name == ".xmp")
    diagnostics.add(0, {}, "the file name is empty before .xmp, so the job has no name: rename the file");
  if (name.native().size() > most_bytes_of_job)
    diagnostics.add(0, {},
                    fmt::format("the job's name has {} bytes, which is too long for the names of its files: "
                                "rename the file, to at most {}",
                                name.native().size(), most_bytes_of_job));
  diagnostics.raise_if_any();
  scene.has_single_particles = body_of_single_particles(scene) != nullptr;
  // A run finds out by itself whether it needs USAVG; of these bodies it is known before.
  if (core::may_change_scheme(scene) && scene.has_single_particles)
    scene.solution.scheme = core::Scheme::usavg;
  scene.provenance = {file.string(), name.string(), fnv1a_hex(bytes)};
  if (options.foreign) *options.foreign = foreign_names(Node(document, 0, root, {}), file.string());
  if (options.notes) *options.notes = idle_settings(Node(document, 0, root, {}), scene);
  return scene;
}

core::Scene read_scene(const std::filesystem::path& job, const core::Catalogue& catalogue,
                       const ReadOptions& options) {
  const std::filesystem::path file = find_input(job);
  return parse_scene(read_bytes(file), file, catalogue, options);
}

}  // namespace mpm::io
