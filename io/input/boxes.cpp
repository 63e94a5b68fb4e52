#include "io/input/boxes.hpp"

#include <algorithm>

namespace mpm::io {

namespace {

Box local_box(const core::Geometry& geometry) {
  Box box;
  const auto around = [&](const core::Vec3<double>& base, double radius, double below, double above) {
    box.include({base[0] - radius, base[1] - radius, base[2] - below});
    box.include({base[0] + radius, base[1] + radius, base[2] + above});
  };
  if (const auto* points = std::get_if<core::PointGeometry>(&geometry))
    for (const core::PointMass& p : points->points) box.include(p.position);
  if (const auto* b = std::get_if<core::BlockGeometry>(&geometry)) {
    box.include(b->origin);
    box.include({b->origin[0] + b->size[0], b->origin[1] + b->size[1], b->origin[2] + b->size[2]});
  }
  if (const auto* s = std::get_if<core::SphereGeometry>(&geometry))
    around(s->centre, s->outer_radius, s->outer_radius, s->outer_radius);
  if (const auto* c = std::get_if<core::CylinderGeometry>(&geometry))
    around(c->base_centre, std::max(c->bottom_outer_radius, c->top_outer_radius), 0, c->height);
  return box;
}

Box global_box(const Box& local, const core::WorkPlane& plane) {
  Box box;
  for (int corner = 0; corner < 8; ++corner) {
    core::Vec3<double> p = plane.origin;
    const core::Vec3<double> r{corner & 1 ? local.upper[0] : local.lower[0],
                               corner & 2 ? local.upper[1] : local.lower[1],
                               corner & 4 ? local.upper[2] : local.lower[2]};
    for (std::size_t i = 0; i < 3; ++i)
      p[i] += r[0] * plane.x_axis[i] + r[1] * plane.y_axis[i] + r[2] * plane.z_axis[i];
    box.include(p);
  }
  return box;
}

}  // namespace

Box box_of(const core::BodyInput& body, const core::Scene& scene) {
  const Box local = local_box(body.geometry);
  if (!body.work_plane || local.empty()) return local;
  return global_box(local, scene.work_planes[*body.work_plane]);
}

}  // namespace mpm::io
