#include "core/discretise/shells.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/discretise/lattice.hpp"
#include "core/discretise/line.hpp"

namespace mpm::core {

namespace {

double bands_at(double radius, double spacing) { return whole_count(std::numbers::pi / 2 * radius, spacing); }

/// Cosine of the polar angle where band `edge` of a hemisphere starts, from the pole.
double edge_cosine(double edge, double bands) {
  return edge == bands ? 0 : std::cos(edge / bands * (std::numbers::pi / 2));
}

}  // namespace

ShellSource::ShellSource(const SphereGeometry& ball, const Frame& frame, double density)
    : ball_(ball),
      sweep_(ball.angle),
      frame_(frame),
      density_(density),
      shells_(whole_count(ball.outer_radius - ball.inner_radius, ball.spacing)) {
  const double bands = bands_at(ball.outer_radius, ball.spacing);
  const double shell_rows = ball.upper_half ? bands : 2 * bands;
  if (!set_extent(shells_ * shell_rows, sweep_.arc_count(ball.outer_radius, ball.spacing))) return;
  most_bands_ = static_cast<std::uint64_t>(bands);
  shell_rows_ = static_cast<std::uint64_t>(shell_rows);
}

void ShellSource::append_row(std::uint64_t row, std::uint64_t first, std::uint64_t last,
                             std::vector<Seed>& out) const {
  const double thickness = (ball_.outer_radius - ball_.inner_radius) / shells_;
  const auto shell = static_cast<double>(row / shell_rows_);
  const double near = ball_.inner_radius + shell * thickness;
  const double far = shell + 1 == shells_ ? ball_.outer_radius : ball_.inner_radius + (shell + 1) * thickness;
  const double cubes = (far - near) * (far * far + far * near + near * near);
  // Centroid of r over the shell: 3/4 (far^4 - near^4)/(far^3 - near^3).
  const double r = 0.75 * (far - near) * (far + near) * (far * far + near * near) / cubes;

  const std::uint64_t line = row % shell_rows_;
  const double bands = bands_at(r, ball_.spacing);
  const auto band = static_cast<double>(line % most_bands_);
  if (band >= bands) return;
  const double from = edge_cosine(band, bands);
  const double to = edge_cosine(band + 1, bands);
  const double cosine = (from + to) / 2;
  const double ring = r * std::sqrt(1 - cosine * cosine);
  const double height = line < most_bands_ ? r * cosine : -r * cosine;

  const auto count = std::min(static_cast<std::uint64_t>(sweep_.arc_count(ring, ball_.spacing)), width());
  const double turn = 2 * std::numbers::pi / 3 * cubes * (from - to);
  const double volume = turn * sweep_.fraction() / static_cast<double>(count);
  for (std::uint64_t i = first; i < std::min(last, count); ++i) {
    const auto [c, s] = sweep_.arc_direction(i, count);
    const Position local{ball_.centre[0] + ring * c, ball_.centre[1] + ring * s, ball_.centre[2] + height};
    out.push_back({frame_.to_global(local), density_ * volume, volume, row * width() + i});
  }
}

double ShellSource::expected_particles() const {
  return solid_volume() / ball_.spacing / ball_.spacing / ball_.spacing;
}

Box ShellSource::bounds() const {
  Box box = ball_box(ball_);
  for (Position& corner : box)
    for (std::size_t d = 0; d < 3; ++d) corner[d] += ball_.centre[d];
  return frame_.to_global(box);
}

double ShellSource::solid_volume() const { return ball_volume(ball_); }

}  // namespace mpm::core
