#include "core/discretise/solid_box.hpp"

#include <algorithm>

#include "core/discretise/frame.hpp"
#include "core/discretise/profile.hpp"

namespace mpm::core {

namespace {

SolidBox local_box(const Scene& scene, const Geometry& geometry) {
  SolidBox box;
  const auto around = [&](const Position& base, double radius, double below, double above) {
    box.include({base[0] - radius, base[1] - radius, base[2] - below});
    box.include({base[0] + radius, base[1] + radius, base[2] + above});
  };
  if (const auto* points = std::get_if<PointGeometry>(&geometry))
    for (const PointMass& p : points->points) box.include(p.position);
  if (const auto* b = std::get_if<BlockGeometry>(&geometry)) {
    box.include(b->origin);
    box.include({b->origin[0] + b->size[0], b->origin[1] + b->size[1], b->origin[2] + b->size[2]});
  }
  if (const auto* s = std::get_if<SphereGeometry>(&geometry))
    around(s->centre, s->outer_radius, s->outer_radius, s->outer_radius);
  if (const auto* c = std::get_if<CylinderGeometry>(&geometry))
    around(c->base_centre, std::max(c->bottom_outer_radius, c->top_outer_radius), 0, c->height);
  if (const auto* o = std::get_if<OgiveGeometry>(&geometry))
    around(o->base_centre, o->end_radius, 0, revolved(*o).profile->height());
  if (const auto* difference = std::get_if<BoolGeometry>(&geometry))
    return solid_box(scene, body_at(scene, difference->minuend));
  return box;
}

}  // namespace

SolidBox solid_box(const Scene& scene, const BodyInput& body) {
  const SolidBox local = local_box(scene, body.geometry);
  if (!body.work_plane || local.empty()) return local;
  const auto [lower, upper] = Frame(scene, body).to_global(Box{local.lower, local.upper});
  return {lower, upper};
}

}  // namespace mpm::core
