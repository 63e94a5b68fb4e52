#include "parallel/implicit/petsc_options.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petscsnes.h>
#include <strings.h>

#include "parallel/implicit/petsc_errors.hpp"
#include "parallel/implicit/solver_library.hpp"

namespace mpm::parallel {

namespace {

/// As PETSc has it: "-1" is a value.
bool is_option(std::string_view word) {
  if (word.starts_with("--")) word.remove_prefix(1);
  return word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0;
}

/// Why PETSc could not read a file of options.
std::string fault_of_file(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!file || (file.peek(), file.bad())) return "cannot be read; check its path";
  for (int number = 1; std::getline(file, line); ++number) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#' || line[first] == '!' || line[first] == '%')
      continue;
    const std::string word = line.substr(first, line.find_first_of(" \t\r", first) - first);
    if (!is_option(word) && word != "alias")
      return fmt::format("has \"{}\" at the start of line {}: expected an option, which begins with -", word,
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

/// The value of an option that has been given; "" also for one without a value.
bool given(const char* name, std::string& value) {
  std::array<char, 256> text{};
  PetscBool found = PETSC_FALSE;
  check_petsc(PetscOptionsGetString(nullptr, nullptr, name, text.data(), text.size(), &found));
  value = text.data();
  return found == PETSC_TRUE;
}

void expect(const char* name, std::span<const char* const> possible, std::string_view why) {
  std::string value;
  if (!given(name, value) || std::ranges::find(possible, value) != possible.end()) return;
  throw WrongSolverOptions(fmt::format("option {} {} of PETSc after --: expected {}{}; change or remove it",
                                       name, value, fmt::join(possible, " or "), why));
}

}  // namespace

std::string fault_of_words(MPI_Comm comm, const std::vector<std::string>& words) {
  bool may_be_value = false;
  std::vector<std::string> strays;
  for (const std::string& word : words) {
    if (!is_option(word) && !may_be_value) strays.push_back(fmt::format("\"{}\"", word));
    may_be_value = is_option(word);
  }
  if (!strays.empty())
    return fmt::format(
        "{} after -- {} to no option of PETSc: options begin with - and have one value at most",
        fmt::join(strays, ", "), strays.size() == 1 ? "belongs" : "belong");
  int rank = 0;
  check_mpi(MPI_Comm_rank(comm, &rank));
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (strcasecmp(words[i].c_str(), "-options_file") != 0) continue;
    if (i + 1 == words.size() || is_option(words[i + 1]))
      return fmt::format("option {} of PETSc after --: the name of a file is missing", words[i]);
    // Rank 0 reads it for all.
    const std::string fault = broadcast(comm, rank == 0 ? fault_of_file(words[i + 1]) : "");
    if (!fault.empty())
      return fmt::format("option {} {} of PETSc after --: the file {}", words[i], words[i + 1], fault);
  }
  return {};
}

void refuse_unsuitable_options(bool linear, bool matrix_free) {
  std::string value;
  // Ours is the test of convergence, which does not read PETSc's tolerances of Newton's method.
  for (const char* name : {"-snes_rtol", "-snes_atol", "-snes_stol", "-snes_convergence_test"})
    if (given(name, value))
      throw WrongSolverOptions(
          fmt::format("option {} of PETSc after -- has no effect: rtol and atol of Implicit decide; set them "
                      "instead",
                      name));
  static constexpr std::array<const char*, 2> of_newton{SNESNEWTONLS, SNESNEWTONTR}, formats{MATAIJ, MATBAIJ};
  static constexpr std::array<const char*, 1> of_system{SNESKSPONLY};
  if (linear)
    expect("-snes_type", of_system, ", as a semi-implicit step is one linear system");
  else
    expect("-snes_type", of_newton, ", which end where rtol of Implicit is met");
  // It would change the type of the product by differences.
  if (matrix_free && given("-mat_type", value))
    throw WrongSolverOptions(
        "option -mat_type of PETSc after -- does not go with jacobian=\"matrixfree\"; remove it");
  expect("-mat_type", formats, ", the formats that are assembled here");
}

void refuse_unused_options() {
  PetscInt n = 0;
  char **names = nullptr, **values = nullptr;
  check_petsc(PetscOptionsLeftGet(nullptr, &n, &names, &values));
  std::string unused;
  for (PetscInt i = 0; i < n; ++i)
    if (std::string(names[i]) != "options_left" && std::string(names[i]) != "no_signal_handler")
      unused += fmt::format("{}-{}", unused.empty() ? "" : ", ", names[i]);
  check_petsc(PetscOptionsLeftRestore(nullptr, &n, &names, &values));
  if (!unused.empty())
    throw WrongSolverOptions("unknown or unused options of PETSc after --: " + unused +
                             "; check their spelling, or remove them");
}

}  // namespace mpm::parallel
