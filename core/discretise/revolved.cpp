#include "core/discretise/revolved.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/discretise/line.hpp"

namespace mpm::core {

namespace {

/// Calls visit(first, last) for some hundred groups of consecutive layers, whatever the number of layers.
template <class Visit>
void for_groups(double layers, Visit&& visit) {
  constexpr double most = 512;
  const double groups = std::fmin(layers, most);
  for (double g = 0; g < groups; ++g) {
    const double first = std::floor(g * (layers / groups));
    visit(first, std::fmax(first, std::floor((g + 1) * (layers / groups)) - 1));
  }
}

double middle(const Grading& grading, double k) { return grading.lower(k) + grading.thickness(k) / 2; }

/// Upper bound over all layers of length(z)/thickness, with z at the middle of a layer of a stack stretched
/// by `stretch`; length must be monotone in z.
template <class Length>
double most_steps(const Grading& grading, double height, double stretch, Length&& length) {
  double most = 0;
  for_groups(grading.layers(), [&](double first, double last) {
    const auto at = [&](double k) { return length(std::fmin(middle(grading, k) * stretch, height)); };
    const double thinnest = std::fmin(grading.thickness(first), grading.thickness(last));
    most = std::fmax(most, std::fmax(at(first), at(last)) / thinnest);
  });
  return most;
}

/// Sum over layers of their area over thickness^2.
double estimate(const Revolved& solid, const Grading& grading) {
  double particles = 0;
  for_groups(grading.layers(), [&](double first, double last) {
    const double k = (first + last) / 2;
    const double h = grading.thickness(k);
    const double z = std::fmin(middle(grading, k), solid.profile->height());
    const double outer = solid.profile->outer(z);
    const double inner = solid.profile->inner(z);
    particles += (last - first + 1) * std::numbers::pi * (outer / h * (outer / h) - inner / h * (inner / h));
  });
  return particles * solid.angle / 360;
}

double turned_volume(const Revolved& solid) {
  return solid.profile->volume(0, solid.profile->height(), 0, 1) * solid.angle / 360;
}

double widest(const Profile& profile) { return std::fmax(profile.outer(0), profile.outer(profile.height())); }

}  // namespace

RevolvedLattice::RevolvedLattice(const Revolved& solid, const Frame& frame, double density)
    : LayeredLattice(solid.base, solid.angle, frame, density),
      solid_(solid),
      grading_(solid.bottom_spacing, solid.top_spacing, solid.profile->height()) {
  const Profile& profile = *solid_.profile;
  const double steps = most_steps(grading_, profile.height(), 1, [&](double z) { return profile.outer(z); });
  // Points at (i + 1/2) spacings, and one that is on the boundary.
  set_layers(grading_.layers(), std::floor(steps * (1 + on_boundary) + 0.5));
}

Layer RevolvedLattice::layer(std::uint64_t k) const {
  const auto number = static_cast<double>(k);
  const double h = grading_.thickness(number);
  const double height = middle(grading_, number);
  const double z = std::fmin(height, solid_.profile->height());
  const double plane =
      grading_.uniform() ? LatticeLine(solid_.base[2], h).at(odd(k)) : solid_.base[2] + height;
  return {plane, h, inner_limit(solid_.profile->inner(z), h), outer_limit(solid_.profile->outer(z), h)};
}

double RevolvedLattice::expected_particles() const { return estimate(solid_, grading_); }

Box RevolvedLattice::bounds() const {
  const double top = middle(grading_, grading_.layers() - 1);
  return placed(sweep().box(widest(*solid_.profile), 0, std::fmax(top, solid_.profile->height())));
}

double RevolvedLattice::solid_volume() const { return turned_volume(solid_); }

RingSource::RingSource(const Revolved& solid, const Frame& frame, double density)
    : solid_(solid),
      grading_(solid.bottom_spacing, solid.top_spacing, solid.profile->height()),
      stretch_(solid.profile->height() / grading_.lower(grading_.layers())),
      sweep_(solid.angle),
      frame_(frame),
      density_(density) {
  const Profile& profile = *solid_.profile;
  const double height = profile.height();
  const auto thickness = [&](double z) { return profile.outer(z) - profile.inner(z); };
  const double wall = most_steps(grading_, height, stretch_, thickness);
  const double radius = most_steps(grading_, height, stretch_, [&](double z) { return profile.outer(z); });
  const double rings = whole_count(wall, stretch_) + 1;  // one more: the bound's round-off
  if (set_extent(grading_.layers() * rings, sweep_.arc_count(radius, stretch_)))
    layer_rings_ = static_cast<std::uint64_t>(rings);
}

void RingSource::append_row(std::uint64_t row, std::uint64_t first, std::uint64_t last,
                            std::vector<Seed>& out) const {
  const Profile& profile = *solid_.profile;
  const auto k = static_cast<double>(row / layer_rings_);
  const auto ring = static_cast<double>(row % layer_rings_);
  const double h = grading_.thickness(k) * stretch_;
  const double lower = grading_.lower(k) * stretch_;
  const double upper = grading_.lower(k + 1) * stretch_;
  const double z = (lower + upper) / 2;
  const double hole = profile.inner(z);
  const double wall = profile.outer(z) - hole;
  const double rings = whole_count(wall, h);
  if (ring >= rings || wall <= 0) return;

  const double near = hole + wall * (ring / rings);
  const double far = hole + wall * ((ring + 1) / rings);
  // Centroid of r over the ring: 2/3 (far^3 - near^3)/(far^2 - near^2).
  const double r = 2.0 / 3 * (far * far + far * near + near * near) / (far + near);
  const auto count = std::min(static_cast<std::uint64_t>(sweep_.arc_count(r, h)), width());
  const double turn = profile.volume(lower, upper, ring / rings, (ring + 1) / rings);
  const double volume = turn * sweep_.fraction() / static_cast<double>(count);
  for (std::uint64_t i = first; i < std::min(last, count); ++i) {
    const auto [c, s] = sweep_.arc_direction(i, count);
    const Position local{solid_.base[0] + r * c, solid_.base[1] + r * s, solid_.base[2] + z};
    out.push_back({frame_.to_global(local), density_ * volume, volume, row * width() + i});
  }
}

double RingSource::expected_particles() const { return estimate(solid_, grading_); }

Box RingSource::bounds() const {
  Box box = sweep_.box(widest(*solid_.profile), 0, solid_.profile->height());
  for (Position& corner : box)
    for (std::size_t d = 0; d < 3; ++d) corner[d] += solid_.base[d];
  return frame_.to_global(box);
}

double RingSource::solid_volume() const { return turned_volume(solid_); }

}  // namespace mpm::core
