#pragma once
// A source whose candidates form rows of one width: candidate number = row * width + column. The numbers are
// the seeds' identities, and a unit is a run of consecutive candidates, so that needles, plates and long rows
// are all divided into pieces of one size.

#include <cstdint>
#include <vector>

#include "core/discretise/seeds.hpp"

namespace mpm::core {

class RowSource : public SeedSource {
 public:
  static constexpr std::uint64_t candidates_per_unit = 4096;

  std::uint64_t units() const final {
    return identities_ / candidates_per_unit + (identities_ % candidates_per_unit != 0);
  }
  std::uint64_t identities() const final { return identities_; }
  void generate(std::uint64_t first_unit, std::uint64_t last_unit, std::vector<Seed>& out) const final;

 protected:
  /// Integers of any size. Returns false, and leaves a source that cannot generate, when their product
  /// reaches identity_limit. No row of candidates counts as none.
  bool set_extent(double rows, double width);

  std::uint64_t rows() const { return rows_; }
  std::uint64_t width() const { return width_; }
  bool numbered() const { return identities_ < identity_limit; }

 private:
  /// Appends the seeds among the columns [first, last) of a row, with identity row * width + column.
  virtual void append_row(std::uint64_t row, std::uint64_t first, std::uint64_t last,
                          std::vector<Seed>& out) const = 0;

  std::uint64_t rows_ = 0;
  std::uint64_t width_ = 0;
  std::uint64_t identities_ = 0;
};

}  // namespace mpm::core
