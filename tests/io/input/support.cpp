#include "tests/io/input/support.hpp"

#include <fstream>

#include <catch2/catch.hpp>
#include <unistd.h>

#include "io/input/specification.hpp"
#include "physics/catalogue.hpp"

namespace mpm::test {

namespace {

core::ParameterInfo optional(std::string_view name, double value) {
  core::ParameterInfo info;
  info.name = name;
  info.default_value = value;
  return info;
}

core::ParameterInfo positive(std::string_view name) {
  core::ParameterInfo info;
  info.name = name;
  info.required = true;
  info.min = 0;
  info.min_open = true;
  return info;
}

core::ParameterInfo group(std::string_view name) {
  core::ParameterInfo info = optional(name, core::no_default);
  info.group = "damage";
  return info;
}

core::Catalogue make_catalogue() {
  core::ParameterInfo poisson = positive("Poisson");
  poisson.max = 0.5;
  poisson.max_open = true;
  core::ParameterInfo failed_type = optional("FailedType", 0);
  failed_type.integer = true;
  failed_type.min = 0;
  failed_type.max = 2;
  core::ParameterInfo pmin = positive("pmin");
  pmin.min = -core::unbounded;
  pmin.max = 0;
  pmin.max_open = true;
  core::Catalogue c;
  c.common_strength = {optional("bq1", 1.5), optional("Young", core::no_default), failed_type};
  c.common_eos = {optional("C0", core::no_default), optional("E0", 0)};
  c.strength = {{"IsoHarden",
                 "linear hardening",
                 {positive("Young"), poisson, positive("Yield0"), positive("TangMod")}},
                {"JohnsonCook", "", {positive("Young"), poisson, group("D1"), group("D2")}},
                {"Null", "fluid", {optional("mu", 0)}},
                {"Homemade", "a law of these tests alone", {positive("strength")}}};
  c.eos = {{"Gruneisen", "shock", {positive("C0"), positive("S1"), positive("gamma0")}}};
  c.failure = {{"none", "", {}}, {"Pmin", "", {pmin}}};
  return c;
}

}  // namespace

const core::Catalogue& small_catalogue() {
  static const core::Catalogue catalogue = make_catalogue();
  return catalogue;
}

std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != text.npos);
  std::string result(text);
  return result.replace(at, from.size(), to);
}

std::string rigid_bar() {
  const std::string text = replaced(bar, law, rigid_law);
  return replaced(text, "<EquationOfState type=\"Gruneisen\" C0=\"3940\" S1=\"1.49\" gamma0=\"1.96\"/>", "");
}

core::Scene parse(std::string_view text, const io::ReadOptions& options) {
  static const io::ElementSpec language = io::language(small_catalogue());
  return io::parse_scene(text, "case.xmp", language, options);
}

core::Scene parse(std::string_view text, std::vector<core::Diagnostic>& notes, bool accept_later) {
  static const io::ElementSpec language = io::language(physics::catalogue());
  return io::parse_scene(text, "case.xmp", language,
                         {.check_files = false, .accept_later = accept_later, .notes = &notes});
}

std::vector<std::string> notes_of(std::string_view text, bool accept_later) {
  std::vector<core::Diagnostic> notes;
  parse(text, notes, accept_later);
  std::vector<std::string> lines;
  for (core::Diagnostic& note : notes) {
    CHECK(note.file == "case.xmp");
    note.file.clear();
    lines.push_back(to_text(note));
  }
  return lines;
}

std::vector<std::string> faults(std::string_view text, const io::ReadOptions& options) {
  try {
    parse(text, options);
  } catch (const core::InputErrors& errors) {
    std::vector<std::string> result;
    for (core::Diagnostic d : errors.diagnostics()) {
      CHECK(d.file == "case.xmp");
      d.file.clear();
      result.push_back(to_text(d));
    }
    return result;
  }
  return {"ok"};
}

void check_faults(const std::vector<Wrong>& table) {
  for (const Wrong& wrong : table) {
    INFO(wrong.from << "  ->  " << wrong.to);
    CHECK(faults(replaced(bar, wrong.from, wrong.to)) == wrong.messages);
  }
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "mpm_test_XXXXXX").string();
  REQUIRE(mkdtemp(pattern.data()) != nullptr);
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TemporaryFolder::write(std::string_view name, std::string_view bytes) const {
  std::ofstream(path_ / name, std::ios::binary) << bytes;
  return path_ / name;
}

}  // namespace mpm::test
