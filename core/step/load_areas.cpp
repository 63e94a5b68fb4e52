#include "core/step/load_areas.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

#include "core/particle_range.hpp"
#include "core/step/load_forces.hpp"

namespace mpm::core {

namespace {

/// Adds a particle.
void add(LoadArea& area, std::span<ExactSum> sums, double ramp, double cell, const ConstParticle& p) {
  const SurfaceLoad& load = *area.load;
  const Vec3<double> x = p.vector(Column::position_x);
  Vec3<double> slope{}, unused{};
  const double size = detail::size_for_loads(p[Column::volume], cell),
               weight = detail::box_weight(load, ramp, x, size, slope);
  area.reached = area.reached || weight > 0;
  for (int a = 0; a < 3; ++a) {
    const double part = p[Column::volume] * slope[a];
    sums[static_cast<std::size_t>(part > 0 ? a : 3 + a)].add(std::abs(part));
  }
  if (load.normal < 0) return;
  Vec3<double> between = x;
  between[load.normal] = 0.5 * (load.lower[load.normal] + load.upper[load.normal]);
  area.crossed = area.crossed || weight < detail::box_weight(load, ramp, between, size, unused);
}

}  // namespace

std::vector<LoadArea> load_areas(const Model& model, Reductions& ranks) {
  const std::vector<const BodyInput*> inputs = active_bodies(*model.scene);
  std::vector<LoadArea> areas;
  for (std::size_t b = 0; b < std::min(model.bodies.size(), inputs.size()); ++b) {
    const std::vector<SurfaceLoad>& loads = inputs[b]->surface_loads;
    for (std::size_t i = 0; i < loads.size(); ++i)
      areas.push_back({.load = &loads[i], .body = b, .number = i + 1});
  }
  if (areas.empty()) return areas;
  constexpr std::size_t of_each = 6;
  std::vector<ExactSum> sums(of_each * areas.size());
  for (const ConstParticleBlock& block : blocks_of(model)) {
    const auto b = static_cast<std::size_t>(block.body);
    const auto mine = std::ranges::lower_bound(areas, b, {}, &LoadArea::body),
               end = std::ranges::upper_bound(areas, b, {}, &LoadArea::body);
    for (LoadArea& area : std::span(mine, end)) {
      const double cell = model.grid->geometry().smallest_cell(), ramp = area.load->ramp.value_or(cell);
      const auto first = static_cast<std::size_t>(&area - areas.data());
      for (const ConstParticle p : block)
        add(area, std::span(sums).subspan(of_each * first, of_each), ramp, cell, p);
    }
  }
  ranks.sum(std::span<ExactSum>(sums));
  std::vector<std::int64_t> flags;
  for (const LoadArea& area : areas) {
    flags.push_back(area.reached ? 1 : 0);
    flags.push_back(area.crossed ? 1 : 0);
  }
  ranks.sum(std::span<std::int64_t>(flags));
  for (std::size_t i = 0; i < areas.size(); ++i) {
    for (int a = 0; a < 3; ++a) {
      const std::size_t at = of_each * i + static_cast<std::size_t>(a);
      areas[i].lower[a] = sums[at].value();
      areas[i].upper[a] = sums[at + 3].value();
    }
    areas[i].reached = flags[2 * i] > 0;
    areas[i].crossed = flags[2 * i + 1] > 0;
  }
  return areas;
}

}  // namespace mpm::core
