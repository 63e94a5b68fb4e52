#include "parallel/implicit/petsc_matrix.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include "parallel/implicit/petsc_errors.hpp"

namespace mpm::parallel {

void MatrixPlaces::add(std::span<const std::int64_t> nodes, const double*) {
  sorted_.assign(nodes.begin(), nodes.end());
  std::erase_if(sorted_, [](std::int64_t n) { return n < 0; });
  std::sort(sorted_.begin(), sorted_.end());
  sorted_.erase(std::unique(sorted_.begin(), sorted_.end()), sorted_.end());
  for (const std::int64_t row : sorted_) {
    std::vector<std::int64_t>& columns =
        mine(row) ? own_[static_cast<std::size_t>(row - first_)] : others_[row];
    if (std::includes(columns.begin(), columns.end(), sorted_.begin(), sorted_.end())) continue;
    merged_.clear();
    std::set_union(columns.begin(), columns.end(), sorted_.begin(), sorted_.end(),
                   std::back_inserter(merged_));
    columns.assign(merged_.begin(), merged_.end());
  }
}

void MatrixPlaces::exchange(MPI_Comm comm) {
  int ranks = 0;
  check_mpi(MPI_Comm_size(comm, &ranks));
  if (ranks == 1) return;
  const auto n = static_cast<std::size_t>(ranks);
  std::vector<std::int64_t> first(n);
  check_mpi(MPI_Allgather(&first_, 1, MPI_INT64_T, first.data(), 1, MPI_INT64_T, comm));
  // Row, number of columns, columns; rows ascend, and so do the ranks that own them.
  std::vector<std::int64_t> sent;
  std::vector<int> sent_count(n), sent_begin(n), count(n), begin(n);
  for (const auto& [row, columns] : others_) {
    // A rank without nodes begins where the next one does: the last that begins no later than the row owns
    // it.
    const auto owner = std::ranges::upper_bound(first, row) - first.begin() - 1;
    const auto before = sent.size();
    sent.push_back(row);
    sent.push_back(static_cast<std::int64_t>(columns.size()));
    sent.insert(sent.end(), columns.begin(), columns.end());
    sent_count[static_cast<std::size_t>(owner)] += static_cast<int>(sent.size() - before);
  }
  others_.clear();
  check_mpi(MPI_Alltoall(sent_count.data(), 1, MPI_INT, count.data(), 1, MPI_INT, comm));
  for (std::size_t r = 1; r < n; ++r) {
    sent_begin[r] = sent_begin[r - 1] + sent_count[r - 1];
    begin[r] = begin[r - 1] + count[r - 1];
  }
  std::vector<std::int64_t> received(static_cast<std::size_t>(begin.back() + count.back()));
  check_mpi(MPI_Alltoallv(sent.data(), sent_count.data(), sent_begin.data(), MPI_INT64_T, received.data(),
                          count.data(), begin.data(), MPI_INT64_T, comm));
  for (std::size_t at = 0; at < received.size();) {
    const std::int64_t row = received[at];
    const auto columns = std::span(received).subspan(at + 2, static_cast<std::size_t>(received[at + 1]));
    at += 2 + columns.size();
    if (!mine(row)) throw std::logic_error("a row of the matrix went to a rank that does not own it");
    std::vector<std::int64_t>& to = own_[static_cast<std::size_t>(row - first_)];
    merged_.clear();
    std::set_union(to.begin(), to.end(), columns.begin(), columns.end(), std::back_inserter(merged_));
    to.assign(merged_.begin(), merged_.end());
  }
}

/// Numbers the levels of the nodes that are connected to `node`, and puts a node of the last in its place.
std::size_t MatrixPlaces::widest_level_from(std::size_t& node, std::vector<int>& level) const {
  std::vector<std::size_t> now{node}, next;
  std::size_t widest = 1;
  level[node] = 1;
  for (int at = 2; !now.empty(); ++at) {
    node = now.front();
    widest = std::max(widest, now.size());
    next.clear();
    for (const std::size_t i : now)
      for (const std::int64_t c : own_[i]) {
        if (!mine(c)) continue;
        const auto other = static_cast<std::size_t>(c - first_);
        if (level[other] != 0) continue;
        level[other] = at;
        next.push_back(other);
      }
    now.swap(next);
  }
  return widest;
}

std::size_t MatrixPlaces::widest_level() const {
  std::vector<int> first(own_.size()), second(own_.size());
  std::size_t widest = 0;
  for (std::size_t i = 0; i < own_.size(); ++i) {
    if (first[i] != 0) continue;
    std::size_t end = i;
    widest_level_from(end, first);
    widest = std::max(widest, widest_level_from(end, second));
  }
  return widest;
}

MatrixValues::MatrixValues(MPI_Comm comm, MatrixPlaces places, std::int64_t all_nodes)
    : places_(std::move(places)) {
  const auto own = static_cast<PetscInt>(places_.own()), all = static_cast<PetscInt>(all_nodes);
  const std::int64_t first = places_.first(), beyond = first + static_cast<std::int64_t>(places_.own());
  check_petsc(MatCreate(comm, &matrix_));
  check_petsc(MatSetSizes(matrix_, 3 * own, 3 * own, 3 * all, 3 * all));
  check_petsc(MatSetBlockSize(matrix_, 3));
  check_petsc(MatSetType(matrix_, MATAIJ));
  check_petsc(MatSetFromOptions(matrix_));
  std::vector<PetscInt> inside(places_.own()), outside(places_.own());
  for (std::size_t i = 0; i < places_.own(); ++i)
    for (const std::int64_t c : places_.columns(i)) ++(c >= first && c < beyond ? inside : outside)[i];
  check_petsc(MatXAIJSetPreallocation(matrix_, 3, inside.data(), outside.data(), nullptr, nullptr));
  std::vector<double> zeros;
  for (std::size_t i = 0; i < places_.own(); ++i) {
    const std::span<const std::int64_t> columns = places_.columns(i);
    numbers_.assign(columns.begin(), columns.end());
    zeros.resize(std::max(zeros.size(), 9 * columns.size()), 0.0);
    const auto row = static_cast<PetscInt>(first + static_cast<std::int64_t>(i));
    check_petsc(MatSetValuesBlocked(matrix_, 1, &row, static_cast<PetscInt>(columns.size()), numbers_.data(),
                                    zeros.data(), INSERT_VALUES));
  }
  check_petsc(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY));
  find_parts();
}

MatrixValues::~MatrixValues() { MatDestroy(&matrix_); }

/// In each part the columns of a row are ascending as they are in `places_`, and all three scalar rows of a
/// node have the same.
void MatrixValues::find_parts() {
  MatType type = nullptr;
  check_petsc(MatGetType(matrix_, &type));
  const std::string_view format = type;
  blocks_ = format == MATSEQBAIJ || format == MATMPIBAIJ;
  if (!blocks_ && format != MATSEQAIJ && format != MATMPIAIJ)
    throw std::logic_error("a matrix of an unknown format");
  const std::int64_t first = places_.first(), beyond = first + static_cast<std::int64_t>(places_.own());
  inner_.first.assign(1, 0);
  outer_.first.assign(1, 0);
  for (std::size_t i = 0; i < places_.own(); ++i) {
    const std::span<const std::int64_t> columns = places_.columns(i);
    const auto n = static_cast<std::size_t>(
        std::ranges::count_if(columns, [&](std::int64_t c) { return c >= first && c < beyond; }));
    inner_.first.push_back(inner_.first.back() + 9 * n);
    outer_.first.push_back(outer_.first.back() + 9 * (columns.size() - n));
  }
}

void MatrixValues::add_product(std::span<const std::int64_t> nodes, std::span<const double> e,
                               double stiffness) {
  // A product of none but held components is no equation.
  if (std::ranges::all_of(e, [](double each) { return each == 0; })) return;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] < 0) continue;
    products_.nodes.push_back(nodes[i]);
    products_.factors.insert(products_.factors.end(), &e[3 * i], &e[3 * i] + 3);
  }
  products_.stiffness.push_back(stiffness);
  products_.first.push_back(products_.nodes.size());
}

void MatrixValues::begin() {
  products_ = {};
  // Anew each time: PETSc makes other ones when it copies a matrix of blocks.
  PetscBool alone = PETSC_FALSE;
  check_petsc(
      PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(matrix_), &alone, MATSEQAIJ, MATSEQBAIJ, ""));
  inner_.matrix = matrix_;
  if (alone == PETSC_FALSE)
    check_petsc((blocks_ ? MatMPIBAIJGetSeqBAIJ : MatMPIAIJGetSeqAIJ)(matrix_, &inner_.matrix, &outer_.matrix,
                                                                      nullptr));
  for (Part* part : {&inner_, &outer_}) {
    if (part->matrix == nullptr) continue;
    check_petsc((blocks_ ? MatSeqBAIJGetArray : MatSeqAIJGetArray)(part->matrix, &part->values));
    std::fill_n(part->values, part->first.back(), PetscScalar{0});
  }
}

void MatrixValues::add(std::span<const std::int64_t> nodes, const double* values) {
  sorted_.clear();
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i] >= 0) sorted_.push_back({nodes[i], i});
  std::ranges::sort(sorted_, {}, &Column::node);
  const std::size_t width = 3 * nodes.size();
  bool others = false;
  for (const Column& row : sorted_) {
    const std::int64_t own = row.node - places_.first();
    if (own >= 0 && own < static_cast<std::int64_t>(places_.own()))
      add_row(static_cast<std::size_t>(own), row.at, values, width);
    else
      others = true;
  }
  if (!others) return;
  numbers_.assign(nodes.begin(), nodes.end());
  for (const Column& row : sorted_) {
    const std::int64_t own = row.node - places_.first();
    if (own >= 0 && own < static_cast<std::int64_t>(places_.own())) continue;
    const auto number = static_cast<PetscInt>(row.node);
    check_petsc(MatSetValuesBlocked(matrix_, 1, &number, static_cast<PetscInt>(numbers_.size()),
                                    numbers_.data(), values + 3 * row.at * width, ADD_VALUES));
  }
}

/// Adds rows 3 `row` .. 3 `row` + 2 of a dense matrix with the columns of `sorted_`.
void MatrixValues::add_row(std::size_t own_node, std::size_t row, const double* values, std::size_t width) {
  const std::span<const std::int64_t> columns = places_.columns(own_node);
  const std::int64_t first = places_.first(), beyond = first + static_cast<std::int64_t>(places_.own());
  std::size_t at = 0, inside = 0;  // columns passed, and those of own nodes among them
  for (const Column& column : sorted_) {
    for (; at < columns.size() && columns[at] < column.node; ++at)
      inside += static_cast<std::size_t>(columns[at] >= first && columns[at] < beyond);
    if (at == columns.size() || columns[at] != column.node)
      throw std::logic_error("an entry of the matrix has no place");
    const bool own = column.node >= first && column.node < beyond;
    const Part& part = own ? inner_ : outer_;
    const std::size_t block = own ? inside : at - inside, begin = part.first[own_node];
    PetscScalar* const to = part.values + begin + (blocks_ ? 9 : 3) * block;
    const std::size_t down = blocks_ ? 1 : (part.first[own_node + 1] - begin) / 3, right = blocks_ ? 3 : 1;
    const double* from = values + 3 * row * width + 3 * column.at;
    for (std::size_t i = 0; i < 3; ++i, from += width)
      for (std::size_t j = 0; j < 3; ++j) to[down * i + right * j] += from[j];
  }
}

void MatrixValues::end() {
  for (Part* part : {&inner_, &outer_})
    if (part->matrix != nullptr)
      check_petsc((blocks_ ? MatSeqBAIJRestoreArray : MatSeqAIJRestoreArray)(part->matrix, &part->values));
  check_petsc(MatAssemblyBegin(matrix_, MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(matrix_, MAT_FINAL_ASSEMBLY));
}

}  // namespace mpm::parallel
