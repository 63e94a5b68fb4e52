// The Jacobian as a matrix of PETSc, by rows (AIJ) or by blocks (BAIJ, -mat_type baij), with its own
// assembly.
//
// MatSetValues looks every entry up in its row, and the particles of a site bring dense matrices of up to 81
// rows (192 with CPDI2): with that, the assembly took three quarters of the time of an implicit run. Here the
// rows of a node are found by 3 x 3 blocks: its columns are sorted, those of the dense matrix too, and one
// walk through both finds all places. Rows of other ranks' nodes go through PETSc's stash.
// Other formats are refused (petsc_options.hpp). Shown by tests/system/physics_implicit_systems.py.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <petscmat.h>

#include "core/implicit/newton_solver.hpp"

namespace mpm::parallel {

/// Where the entries are: the columns of every own row of nodes, and of rows of other ranks.
class MatrixPlaces final : public core::BlockMatrix {
 public:
  MatrixPlaces(std::int64_t first_node, std::int64_t own_nodes)
      : first_(first_node), own_(static_cast<std::size_t>(own_nodes)) {}
  /// `values` is null. Negative numbers are no nodes.
  void add(std::span<const std::int64_t> nodes, const double* values) override;
  bool keeps_products() const override { return true; }
  void add_product(std::span<const std::int64_t>, std::span<const double>, double) override {
    has_products_ = true;
  }
  /// Whether this rank has any.
  bool has_products() const { return has_products_; }
  /// Moves the columns of other ranks' rows to their owners. Collective.
  void exchange(MPI_Comm comm);

  std::int64_t first() const { return first_; }
  std::size_t own() const { return own_.size(); }
  /// Ascending.
  std::span<const std::int64_t> columns(std::size_t own_node) const { return own_[own_node]; }
  /// Nodes in the widest level, counted from an end of the graph: a matrix of slender bodies has few. Of this
  /// rank's nodes alone.
  std::size_t widest_level() const;
  /// Once exchanged.
  bool same_as(const MatrixPlaces& other) const { return first_ == other.first_ && own_ == other.own_; }

 private:
  std::size_t widest_level_from(std::size_t& node, std::vector<int>& level) const;
  bool mine(std::int64_t node) const {
    return node >= first_ && node < first_ + static_cast<std::int64_t>(own_.size());
  }

  std::int64_t first_;
  std::vector<std::vector<std::int64_t>> own_;
  std::map<std::int64_t, std::vector<std::int64_t>> others_;
  std::vector<std::int64_t> sorted_, merged_;
  bool has_products_ = false;
};

/// Values of a matrix with these places.
class MatrixValues final : public core::BlockMatrix {
 public:
  /// An assembled matrix of zeros. Collective.
  MatrixValues(MPI_Comm comm, MatrixPlaces places, std::int64_t all_nodes);
  ~MatrixValues() override;
  MatrixValues(const MatrixValues&) = delete;
  MatrixValues& operator=(const MatrixValues&) = delete;

  Mat matrix() const { return matrix_; }
  const MatrixPlaces& places() const { return places_; }
  /// Products stiffness e e^T that are kept apart: entries of product c from first[c] to first[c + 1].
  struct Products {
    std::vector<double> stiffness;
    std::vector<std::size_t> first{0};
    std::vector<std::int64_t> nodes;
    std::vector<double> factors;  ///< e, three per node
  };
  const Products& products() const { return products_; }
  void keep_products(bool keep) { keeps_products_ = keep; }
  bool keeps_products() const override { return keeps_products_; }
  void add_product(std::span<const std::int64_t> nodes, std::span<const double> e, double stiffness) override;
  /// Sets all values to zero.
  void begin();
  void add(std::span<const std::int64_t> nodes, const double* values) override;
  /// Collective.
  void end();

 private:
  /// One of the two parts of the matrix: columns of own nodes, and of others'.
  struct Part {
    Mat matrix = nullptr;
    std::vector<std::size_t> first;  ///< by own node: its first value; and the end
    PetscScalar* values = nullptr;   ///< between begin() and end()
  };
  void find_parts();
  void add_row(std::size_t own_node, std::size_t row, const double* values, std::size_t width);

  MatrixPlaces places_;
  Mat matrix_ = nullptr;
  bool blocks_ = false;  ///< it is BAIJ, whose blocks are stored column by column
  Part inner_, outer_;
  struct Column {
    std::int64_t node;
    std::size_t at;  ///< in the dense matrix
  };
  std::vector<Column> sorted_;
  Products products_;
  bool keeps_products_ = false;
  std::vector<PetscInt> numbers_;
};

}  // namespace mpm::parallel
