#include "parallel/mpi_reductions.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace mpm::parallel {

namespace {

// Maps doubles to integers of the same order, for MPI_MIN; NaN is mapped to the smallest.
constexpr std::int64_t not_a_number = std::numeric_limits<std::int64_t>::min();

std::int64_t ordered(double x) {
  if (x != x) return not_a_number;
  const auto bits = std::bit_cast<std::int64_t>(x);
  return bits < 0 ? bits ^ std::numeric_limits<std::int64_t>::max() : bits;
}

double from_ordered(std::int64_t i) {
  if (i == not_a_number) return std::numeric_limits<double>::quiet_NaN();
  return std::bit_cast<double>(i < 0 ? i ^ std::numeric_limits<std::int64_t>::max() : i);
}

}  // namespace

bool MpiReductions::any(bool mine) {
  std::int64_t one = mine ? 1 : 0;
  comm_.reduce(std::span(&one, 1), MPI_MAX);
  return one != 0;
}

void MpiReductions::minimum(std::span<double> values) {
  std::vector<std::int64_t> keys(values.size());
  std::transform(values.begin(), values.end(), keys.begin(), ordered);
  comm_.reduce(keys, MPI_MIN);
  std::transform(keys.begin(), keys.end(), values.begin(), from_ordered);
}

void MpiReductions::sum(std::span<std::int64_t> values) { comm_.reduce(values, MPI_SUM); }

void MpiReductions::sum(std::span<core::ExactSum> values) {
  std::vector<std::int64_t> limbs;
  for (core::ExactSum& v : values) {
    v.normalise();
    limbs.insert(limbs.end(), v.raw().begin(), v.raw().end());
  }
  comm_.reduce(limbs, MPI_SUM);
  auto from = limbs.begin();
  for (core::ExactSum& v : values) {
    const auto to = v.raw();
    std::copy_n(from, to.size(), to.begin());
    from += static_cast<std::ptrdiff_t>(to.size());
    v.normalise();
  }
}

core::StepStatus MpiReductions::combine(const core::StepStatus& mine) {
  // One message: the smallest step, and the minimum of each negated flag.
  std::array<std::int64_t, 4> keys{ordered(mine.stable_step), !mine.needs_bricks, !mine.failed, !mine.stop};
  comm_.reduce(keys, MPI_MIN);
  return {from_ordered(keys[0]), keys[1] == 0, keys[2] == 0, keys[3] == 0};
}

std::vector<std::string> MpiReductions::gather(const std::string& mine) {
  const Gathered<char> all = comm_.all_gather(std::span<const char>(mine));
  std::vector<std::string> lines;
  for (int r = 0; r < size(); ++r) lines.emplace_back(all.of(r).begin(), all.of(r).end());
  return lines;
}

core::Spread MpiReductions::spread(double mine) {
  std::array<double, 2> ends{mine, -mine};
  double total = mine;
  comm_.reduce(ends, MPI_MIN);
  comm_.reduce(std::span(&total, 1), MPI_SUM);
  return {ends[0], total / size(), -ends[1]};
}

}  // namespace mpm::parallel
