#include "core/discretise/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/discretise/line.hpp"

namespace mpm::core {

namespace {

Span common(Span a, Span b) { return {std::max(a.begin, b.begin), std::min(a.end, b.end)}; }

double squared_steps(double radius, double spacing) {
  const double steps = 2 * radius / spacing;
  return steps * steps;
}

}  // namespace

std::int64_t outer_limit(double radius, double spacing) {
  return static_cast<std::int64_t>(std::floor(squared_steps(radius, spacing) * (1 + on_boundary)));
}

std::int64_t inner_limit(double radius, double spacing) {
  return static_cast<std::int64_t>(std::ceil(squared_steps(radius, spacing) * (1 - on_boundary)));
}

LayeredLattice::LayeredLattice(const Position& centre, double angle, const Frame& frame, double density)
    : centre_(centre), sweep_(angle), frame_(frame), density_(density) {}

void LayeredLattice::set_layers(double layers, double half_columns) {
  const double rows = sweep_.only_positive_y() ? half_columns : 2 * half_columns;
  const double columns = sweep_.only_positive_x() ? half_columns : 2 * half_columns;
  if (!set_extent(layers * rows, columns) || identities() == 0) return;
  layer_rows_ = static_cast<std::uint64_t>(rows);
  const auto half = static_cast<std::int64_t>(half_columns);
  first_row_ = sweep_.only_positive_y() ? 0 : -half;
  first_column_ = sweep_.only_positive_x() ? 0 : -half;
}

Box LayeredLattice::placed(Box box) const {
  for (Position& corner : box)
    for (std::size_t d = 0; d < 3; ++d) corner[d] += centre_[d];
  return frame_.to_global(box);
}

std::array<Span, 2> LayeredLattice::columns(const Layer& layer, std::int64_t row) const {
  const std::int64_t odd_row = 2 * row + 1;
  const std::int64_t square = odd_row * odd_row;
  const Span right{odd_roots(layer.inner - square - 1), odd_roots(layer.outer - square)};
  const Span swept = sweep_.columns(odd_row);
  return {common({-right.end, -right.begin}, swept), common(right, swept)};
}

void LayeredLattice::append_row(std::uint64_t row, std::uint64_t first, std::uint64_t last,
                                std::vector<Seed>& out) const {
  const Layer plane = layer(row / layer_rows_);
  const std::int64_t j = first_row_ + static_cast<std::int64_t>(row % layer_rows_);
  const double h = plane.spacing;
  const double volume = h * h * h;
  const LatticeLine x(centre_[0], h);
  const double y = LatticeLine(centre_[1], h).at(odd(j));
  const Span wanted{first_column_ + static_cast<std::int64_t>(first),
                    first_column_ + static_cast<std::int64_t>(last)};
  for (const Span& span : columns(plane, j)) {
    const Span part = common(span, wanted);
    for (std::int64_t i = part.begin; i < part.end; ++i)
      out.push_back({frame_.to_global(Position{x.at(odd(i)), y, plane.z}), density_ * volume, volume,
                     row * width() + static_cast<std::uint64_t>(i - first_column_)});
  }
}

BallLattice::BallLattice(const SphereGeometry& ball, const Frame& frame, double density)
    : LayeredLattice(ball.centre, ball.angle, frame, density), ball_(ball) {
  const double radius_in_steps =
      std::sqrt(std::floor(squared_steps(ball.outer_radius, ball.spacing) * (1 + on_boundary)));
  const double half = std::floor((std::floor(radius_in_steps) + 1) / 2);
  set_layers(ball.upper_half ? half : 2 * half, half);
  if (!numbered()) return;
  outer_ = outer_limit(ball.outer_radius, ball.spacing);
  inner_ = inner_limit(ball.inner_radius, ball.spacing);
  first_layer_ = ball.upper_half ? 0 : -static_cast<std::int64_t>(half);
}

Layer BallLattice::layer(std::uint64_t k) const {
  const std::int64_t c = 2 * (first_layer_ + static_cast<std::int64_t>(k)) + 1;
  const double z = LatticeLine(ball_.centre[2], ball_.spacing).at(static_cast<double>(c));
  return {z, ball_.spacing, inner_ - c * c, outer_ - c * c};
}

double BallLattice::expected_particles() const {
  return solid_volume() / ball_.spacing / ball_.spacing / ball_.spacing;
}

Box BallLattice::bounds() const { return placed(ball_box(ball_)); }

double BallLattice::solid_volume() const { return ball_volume(ball_); }

double ball_volume(const SphereGeometry& ball) {
  const double r = ball.outer_radius;
  const double hole = ball.inner_radius;
  const double part = ball.angle / 360 * (ball.upper_half ? 0.5 : 1);
  return part * 4 / 3 * std::numbers::pi * (r * r * r - hole * hole * hole);
}

Box ball_box(const SphereGeometry& ball) {
  const double r = ball.outer_radius;
  return Sweep(ball.angle).box(r, ball.upper_half ? 0 : -r, r);
}

}  // namespace mpm::core
