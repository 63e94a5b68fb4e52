// Averaged volume changes in the passes of an implicit step (site_dilatation.hpp for the formulas): the means
// of a tile are found in a pass of their own before its particles are. Part of implicit_passes_with.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "core/contact/rigid_state.hpp"
#include "core/implicit/implicit_passes_with.hpp"
#include "core/shape/bspline.hpp"

namespace mpm::core {

/// Of the tile's sites, from the displacements.
template <ShapePolicy S>
void ImplicitPassesWith<S>::find_dilatations(const ParticleTile& tile, const Body& body,
                                             const BrickFrame& frame, Scratch& at) {
  const int volume = body.pool->layout().offset(Column::volume);
  at.dilatation.begin(model_.grid->shape().nodes());
  for_each_batch(tile, frame, Blocks::own, at, [&](std::size_t) {
    take_gradients(frame, at);
    for (int i = 0; i < at.batch.particles; ++i) {
      const double v = at.batch.block[i / block_lanes][volume + i % block_lanes];
      SiteDilatation::Site& site = site_of(at, i);
      site.volume += v;
      site.grown += v * determinant(plus_unit(load_rows<double>(at.gradient, i), 1.0));
    }
  });
}

/// Also keeps the volumes at the start of the step.
template <ShapePolicy S>
bool ImplicitPassesWith<S>::average_gradients(Scratch& at) {
  const Batch& batch = at.batch;
  bool usable = true;
  for (int n = 0; n < 9; ++n) std::copy_n(at.gradient[n], batch_particles, at.averaged[n]);
  for (int i = 0; i < batch.particles; ++i) {
    at.volume[i] = batch.block[i / block_lanes][batch.layout->offset(Column::volume) + i % block_lanes];
    usable =
        average_gradient(Deformation(at.gradient, i), site_of(at, i).dilatation(), i, at.averaged) && usable;
  }
  return usable;
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::find_site_stress(const ParticleTile& tile, const Body& body,
                                             const BrickFrame& frame, Scratch& at) {
  for_each_batch(tile, frame, Blocks::copies, at, [&](std::size_t) {
    take_strains(frame, body, at);
    body.model->update(at.batch, model_.options);
    for (int i = 0; i < at.batch.particles; ++i)
      site_of(at, i).stress += at.volume[i] * mean_stress(at.batch, i);
  });
}

/// f(the node of the site, grad S) for the nodes of particle i.
template <ShapePolicy S>
template <class F>
void ImplicitPassesWith<S>::add_to_nodes(Scratch& at, int i, F f) const {
  SiteDilatation::Site& site = site_of(at, i);
  std::size_t place = 0;
  S::for_each_node(at.places[i / block_lanes], i % block_lanes, model_.grid->geometry().inverse_cell,
                   [&](int node, double, const Vec3<double>& slope) { f(site.of(node, place++), slope); });
}

/// The updated batch: the particles' own part of the forces; the mean stress acts once that of all is known.
template <ShapePolicy S>
void ImplicitPassesWith<S>::average_stress(Scratch& at) const {
  for (int i = 0; i < at.batch.particles; ++i) {
    const Deformation particle(at.gradient, i);
    deviatoric_stress(particle, at.batch, i, at.stress);
    site_of(at, i).stress += at.volume[i] * mean_stress(at.batch, i);
    const Mat3<double> growth = at.volume[i] * particle.j * particle.w;
    add_to_nodes(at, i, [&](SiteDilatation::OfNode& node, const Vec3<double>& slope) {
      node.growth = node.growth + growth * slope;
    });
  }
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::add_site_forces(const Scratch& at, double* contributions) {
  for (const SiteDilatation::Site& site : at.dilatation.used()) {
    for (const SiteDilatation::OfNode& node : site.nodes) {
      double* const to = contributions + node_doubles * node.node;
      for (int a = 0; a < 3; ++a) {
        const double force = site.mean_stress() * node.growth[a];
        to[node_field::force.first + a] -= force;
        to[node_field::support.first] += std::abs(force);
      }
    }
  }
}

/// at.tangent for the particles alone, and the vectors that couple them.
template <ShapePolicy S>
void ImplicitPassesWith<S>::average_tangent(Scratch& at) const {
  for (int i = 0; i < at.batch.particles; ++i) {
    SiteDilatation::Site& site = site_of(at, i);
    const DilatationTangent of = dilatation_tangent(Deformation(at.gradient, i), site, at.volume[i], i,
                                                    at.averaged, at.stress, at.tangent);
    site.second += of.second;
    add_to_nodes(at, i, [&](SiteDilatation::OfNode& node, const Vec3<double>& slope) {
      node.growth = node.growth + of.growth * slope;
      node.before = node.before + of.before * slope;
      node.after = node.after + of.after * slope;
    });
  }
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::touch_site_nodes(Scratch& at) const {
  for (int i = 0; i < at.batch.particles; ++i)
    add_to_nodes(at, i, [](SiteDilatation::OfNode&, const Vec3<double>&) {});
}

/// Where the bulk modulus is 300 times the shear modulus (Poisson's ratio 0.4983) or more: 8 times the shear
/// modulus, with splines twice, by the iterations that were measured (docs/implicit.md, "Jacobian and linear
/// solver"). Below, and with averages around nodes of functions with kinks, solvers do as well with the whole
/// sum.
template <ShapePolicy S>
double ImplicitPassesWith<S>::softness_of(const ConstitutiveModel& material) {
  constexpr bool spline = std::is_same_v<S, QuadraticBSpline> || std::is_same_v<S, CubicBSpline>;
  constexpr bool gains = spline || S::site == Site::cell;
  const double c = material.initial_sound_speed(), shear = material.initial_shear_speed();
  const bool nearly_incompressible = shear > 0 && c * c - 4.0 / 3 * shear * shear >= 300 * shear * shear;
  return gains && nearly_incompressible ? (spline ? 2 : 8) * material.reference_density() * shear * shear
                                        : std::numeric_limits<double>::infinity();
}

/// The couplings of each site, or their structure alone; with_matrix(f) calls f(matrix), and flush() empties
/// the sum after it. `softness`: the part of a bulk stiffness, as a modulus, that stays in the sum; what is
/// above it is passed on as products. Infinite where nothing is.
template <ShapePolicy S>
template <class W, class F>
void ImplicitPassesWith<S>::add_site_stiffness(Scratch& at, bool structure_alone, double softness,
                                               W with_matrix, F flush) {
  std::vector<double> e, g, m;
  for (const SiteDilatation::Site& site : at.dilatation.used()) {
    if (structure_alone) {
      for (const SiteDilatation::OfNode& node : site.nodes) at.stiffness.unknown_of(node.node);
      if (std::isfinite(softness))
        with_matrix([&](BlockMatrix& matrix) { at.stiffness.pass_product(matrix, {}, 0); });
      flush();
      continue;
    }
    const double scale = 1 / site.grown;
    const double bulk = site.second / site.grown - site.mean_stress();
    const double more = std::min(bulk, softness);
    for (std::vector<double>* each : {&e, &g, &m}) each->assign(3 * site.nodes.size(), 0.0);
    for (const SiteDilatation::OfNode& node : site.nodes) {
      const StiffnessBlock::Unknown to = at.stiffness.unknown_of(node.node);
      for (int a = 0; a < 3; ++a) {
        const std::size_t k = 3 * to.place + static_cast<std::size_t>(a);
        e[k] += to.sign[a] * node.growth[a];
        g[k] += to.sign[a] * scale * node.before[a];
        m[k] += to.sign[a] * scale * (node.after[a] + more * node.growth[a]);
      }
    }
    at.stiffness.add_product(g, e);
    at.stiffness.add_product(e, m);
    if (more < bulk)
      with_matrix([&](BlockMatrix& matrix) { at.stiffness.pass_product(matrix, e, (bulk - more) * scale); });
    flush();
  }
}

}  // namespace mpm::core
