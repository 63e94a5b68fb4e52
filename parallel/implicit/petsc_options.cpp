#include "parallel/implicit/petsc_options.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petscsnes.h>
#include <strings.h>

#include "parallel/implicit/petsc_errors.hpp"
#include "parallel/implicit/solver_library.hpp"

namespace mpm::parallel {

namespace {

constexpr std::string_view after_dashes = "after --",
                           in_environment = "in the environment variable PETSC_OPTIONS",
                           in_file = "in a file .petscrc";

/// As PETSc has it: "-1" is a value.
bool is_option(std::string_view word) {
  if (word.starts_with("--")) word.remove_prefix(1);
  return word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0;
}

bool same_name(const std::string& a, const char* b) { return strcasecmp(a.c_str(), b) == 0; }

/// What PETSc takes for words: what quotes enclose is one.
std::vector<std::string> words_of(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n";
  std::vector<std::string> words;
  for (;;) {
    const std::size_t first = text.find_first_not_of(blank);
    if (first == std::string_view::npos) return words;
    text.remove_prefix(first);
    const char quote = text[0];
    const bool quoted = quote == '"' || quote == '\'';
    if (quoted) text.remove_prefix(1);
    const std::size_t end = std::min(text.size(), quoted ? text.find(quote) : text.find_first_of(blank));
    words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(text.size(), end + 1));
  }
}

/// Why PETSc could not read a file of options; it would end rank 0 alone.
std::string fault_of_file(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!file || (file.peek(), file.bad())) return "cannot be read; check its path";
  for (int number = 1; std::getline(file, line); ++number) {
    const std::vector<std::string> words = words_of(std::string_view(line).substr(0, line.find('#')));
    if (words.empty()) continue;
    const bool alias = same_name(words[0], "alias");
    if (!is_option(words[0]) && !alias)
      return fmt::format("has \"{}\" at the start of line {}: expected an option, which begins with -",
                         words[0], number);
    if (alias && (words.size() != 3 || !is_option(words[1]) || !is_option(words[2])))
      return fmt::format("has an alias in line {}: expected two options after it", number);
    if (!alias && (words.size() > 2 || (words.size() == 2 && is_option(words[1]))))
      return fmt::format("has \"{}\" in line {}: expected one option, and one value at most", words.back(),
                         number);
  }
  return {};
}

std::string broadcast(MPI_Comm comm, std::string text) {
  auto size = static_cast<int>(text.size());
  check_mpi(MPI_Bcast(&size, 1, MPI_INT, 0, comm));
  text.resize(static_cast<std::size_t>(size));
  check_mpi(MPI_Bcast(text.data(), size, MPI_CHAR, 0, comm));
  return text;
}

/// f() of rank 0, which reads for all.
template <class F>
std::string from_root(MPI_Comm comm, F f) {
  int rank = 0;
  check_mpi(MPI_Comm_rank(comm, &rank));
  return broadcast(comm, rank == 0 ? f() : std::string());
}

/// What is wrong with the words themselves; empty if nothing. Collective.
std::string fault_of_words(MPI_Comm comm, const std::vector<std::string>& words, std::string_view origin) {
  bool may_be_value = false;
  std::vector<std::string> strays;
  for (const std::string& word : words) {
    if (!is_option(word) && !may_be_value) strays.push_back(fmt::format("\"{}\"", word));
    may_be_value = is_option(word);
  }
  if (!strays.empty())
    return fmt::format("{} {} {} to no option of PETSc: options begin with - and have one value at most",
                       fmt::join(strays, ", "), origin, strays.size() == 1 ? "belongs" : "belong");
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!same_name(words[i], "-options_file")) continue;
    if (i + 1 == words.size() || is_option(words[i + 1]))
      return fmt::format("option {} of PETSc {}: the name of a file is missing", words[i], origin);
    const std::string fault = from_root(comm, [&] { return fault_of_file(words[i + 1]); });
    if (!fault.empty())
      return fmt::format("option {} {} of PETSc {}: the file {}", words[i], words[i + 1], origin, fault);
  }
  return {};
}

/// Of the files that PETSc reads by itself, where there are any.
std::string fault_of_own_files() {
  std::vector<std::string> paths{".petscrc", "petscrc"};
  if (const char* const home = std::getenv("HOME")) paths.push_back(std::string(home) + "/.petscrc");
  for (const std::string& path : paths) {
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(path, unknown) || !std::ifstream(path)) continue;
    if (const std::string fault = fault_of_file(path); !fault.empty())
      return fmt::format("the file {}, whose options PETSc takes, {}; correct it, or add -- -skip_petscrc",
                         path, fault);
  }
  return {};
}

/// Whether these words give an option, as PETSc reads them.
bool gives(const std::vector<std::string>& words, const std::string& name) {
  std::vector<std::string> copy = words;
  std::vector<char*> pointers;
  for (std::string& word : copy) pointers.push_back(word.data());
  PetscOptions alone = nullptr;
  PetscBool found = PETSC_FALSE;
  check_petsc(PetscOptionsCreate(&alone));
  check_petsc(PetscOptionsInsertArgs(alone, static_cast<int>(pointers.size()), pointers.data()));
  check_petsc(PetscOptionsHasName(alone, nullptr, name.c_str(), &found));
  check_petsc(PetscOptionsDestroy(&alone));
  return found == PETSC_TRUE;
}

/// Options that are set here (PetscSolver).
bool is_ours(const std::string& name) {
  return name == "-options_left" || name == "-no_signal_handler" || name == null_pivots_of_mumps;
}

}  // namespace

std::optional<std::string> option_value(const char* name) {
  std::array<char, 256> text{};
  PetscBool found = PETSC_FALSE;
  check_petsc(PetscOptionsGetString(nullptr, nullptr, name, text.data(), text.size(), &found));
  if (found == PETSC_FALSE) return {};
  return text.data();
}

UserOptions::UserOptions(MPI_Comm comm, std::vector<std::string> words) : words_(std::move(words)) {
  environment_ = words_of(from_root(comm, [] {
    const char* const text = std::getenv("PETSC_OPTIONS");
    return std::string(text != nullptr ? text : "");
  }));
  std::string fault = fault_of_words(comm, words_, after_dashes);
  if (fault.empty()) fault = fault_of_words(comm, environment_, in_environment);
  const bool skip =
      std::ranges::any_of(words_, [](const std::string& w) { return same_name(w, "-skip_petscrc"); });
  if (fault.empty() && !skip) fault = from_root(comm, fault_of_own_files);
  if (!fault.empty()) throw WrongSolverOptions(fault);
}

std::string_view UserOptions::origin_of(const std::string& name) const {
  return gives(words_, name) ? after_dashes : gives(environment_, name) ? in_environment : in_file;
}

/// Behind where they come from.
std::string UserOptions::all_in_words() const {
  char* text = nullptr;
  check_petsc(PetscOptionsGetAll(nullptr, &text));
  std::vector<std::string> of_files;
  bool of_file = false;
  for (const std::string& word : words_of(text)) {
    if (is_option(word)) of_file = !is_ours(word) && origin_of(word) == in_file;
    if (of_file) of_files.push_back(word);
  }
  check_petsc(PetscFree(text));
  std::vector<std::string> parts;
  const auto add = [&](std::string_view origin, const std::vector<std::string>& words) {
    if (!words.empty()) parts.push_back(fmt::format("{} ({})", origin, fmt::join(words, " ")));
  };
  add(after_dashes, words_);
  add(in_environment, environment_);
  add(in_file, of_files);
  return fmt::format("{}", fmt::join(parts, ", "));
}

void UserOptions::refuse(std::string_view why) const {
  throw WrongSolverOptions(
      fmt::format("options of PETSc {}: {}; check their values, or remove them", all_in_words(), why));
}

void UserOptions::refuse_unsuitable(bool linear, bool matrix_free) const {
  // Ours is the test of convergence, which reads neither PETSc's tolerances of Newton's method nor its
  // limits.
  static constexpr const char* tolerances = "rtol and atol of Implicit decide; set them instead";
  static constexpr const char* most =
      "max_newton of Implicit decides when a step is given up; set it instead";
  static constexpr std::array<std::pair<const char*, const char*>, 6> without_effect{
      {{"-snes_rtol", tolerances},
       {"-snes_atol", tolerances},
       {"-snes_stol", tolerances},
       {"-snes_convergence_test", tolerances},
       {"-snes_max_it", most},
       {"-snes_divergence_tolerance", most}}};
  for (const auto& [name, why] : without_effect)
    if (option_value(name))
      throw WrongSolverOptions(
          fmt::format("option {} of PETSc {} has no effect: {}", name, origin_of(name), why));
  const auto expect = [&](const char* name, std::span<const char* const> possible, std::string_view why) {
    const std::optional<std::string> value = option_value(name);
    if (value && std::ranges::find(possible, *value) == possible.end())
      throw WrongSolverOptions(fmt::format("option {} {} of PETSc {}: expected {}{}; change or remove it",
                                           name, *value, origin_of(name), fmt::join(possible, " or "), why));
  };
  static constexpr std::array<const char*, 2> of_newton{SNESNEWTONLS, SNESNEWTONTR}, formats{MATAIJ, MATBAIJ};
  static constexpr std::array<const char*, 1> of_system{SNESKSPONLY};
  if (linear)
    expect("-snes_type", of_system, ", as a semi-implicit step is one linear system");
  else
    expect("-snes_type", of_newton, ", which end where rtol of Implicit is met");
  // It would change the type of the product by differences.
  if (matrix_free && option_value("-mat_type"))
    throw WrongSolverOptions(
        fmt::format("option -mat_type of PETSc {} does not go with jacobian=\"matrixfree\"; remove it",
                    origin_of("-mat_type")));
  expect("-mat_type", formats, ", the formats that are assembled here");
}

void UserOptions::refuse_unused() const {
  PetscInt n = 0;
  char **names = nullptr, **values = nullptr;
  check_petsc(PetscOptionsLeftGet(nullptr, &n, &names, &values));
  std::vector<std::string> unused, parts;
  for (PetscInt i = 0; i < n; ++i) unused.push_back(fmt::format("-{}", names[i]));
  check_petsc(PetscOptionsLeftRestore(nullptr, &n, &names, &values));
  std::erase_if(unused, [&](const std::string& name) { return is_ours(name) && origin_of(name) == in_file; });
  for (const std::string_view origin : {after_dashes, in_environment, in_file}) {
    std::vector<std::string> of_origin = unused;
    std::erase_if(of_origin, [&](const std::string& name) { return origin_of(name) != origin; });
    if (!of_origin.empty()) parts.push_back(fmt::format("{}: {}", origin, fmt::join(of_origin, ", ")));
  }
  if (!parts.empty())
    throw WrongSolverOptions(
        fmt::format("unknown or unused options of PETSc {}; check their spelling, or remove them",
                    fmt::join(parts, ", ")));
}

}  // namespace mpm::parallel
