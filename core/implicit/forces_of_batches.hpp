// The residual of an implicit step and its derivative for given displacements of the nodes, batch by batch:
// internal forces, and the stiffness of each site's particles. Part of implicit_passes_with.hpp.
#pragma once

#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include "core/implicit/implicit_passes_with.hpp"

namespace mpm::core {

template <ShapePolicy S>
bool ImplicitPassesWith<S>::map_forces(const AlignedDoubles& displacements) {
  const Vec3<double> inverse_cell = model_.grid->geometry().inverse_cell;
  std::atomic<bool> usable = true;
  for_fields([&](const BrickField& field, Scratch& at) {
    const BrickFrame frame(*model_.grid, field.slot, field.number);
    double* const contributions = clear_contributions(field);
    at.displacements.take_strain(frame, records(displacements, field));
    for_each_tile(field, false, [&](const ParticleTile& tile, const Body& body) {
      if (averages_) find_dilatations(tile, body, frame, at);
      for_each_batch(tile, frame, Blocks::copies, at, [&](std::size_t) {
        Batch& batch = at.batch;
        if (!take_strains(frame, body, at)) usable = false;
        body.model->update(batch, model_.options);
        if (batch.events.not_finite > 0 || batch.events.negative_volume > 0) usable = false;
        if (averages_)
          average_stress(at);
        else
          nodal_stress(at.gradient, batch, at.stress);
        for (int i = 0; i < batch.particles; ++i) {
          double p[9];
          for (int c = 0; c < 9; ++c) p[c] = at.stress[c][i];
          S::for_each_node(at.places[i / block_lanes], i % block_lanes, inverse_cell,
                           [&](int node, double, const Vec3<double>& slope) {
                             double* to = contributions + node_doubles * node;
                             for (int a = 0; a < 3; ++a) {
                               const double force =
                                   p[3 * a] * slope.x + p[3 * a + 1] * slope.y + p[3 * a + 2] * slope.z;
                               to[node_field::force.first + a] -= force;
                               to[node_field::support.first] += std::abs(force);
                             }
                           });
        }
      });
      if (averages_) add_site_forces(at, contributions);
    });
    fold(mapped::implicit_force, field, contributions);
  });
  return usable;
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::add_tangent(const AlignedDoubles* displacements, const NodeUnknowns& unknowns,
                                        BlockMatrix& matrix) {
  const Vec3<double> inverse_cell = model_.grid->geometry().inverse_cell;
  std::mutex matrix_lock;
  for_fields([&](const BrickField& field, Scratch& at) {
    const BrickFrame frame(*model_.grid, field.slot, field.number);
    StiffnessBlock& stiffness = at.stiffness;
    stiffness.begin(unknowns.of(field), unknowns.nodes());
    if (displacements != nullptr) at.displacements.take_strain(frame, records(*displacements, field));
    const auto with_matrix = [&](auto f) {
      const std::lock_guard one_at_a_time(matrix_lock);
      f(matrix);
    };
    const auto flush = [&] {
      with_matrix([&](BlockMatrix& of) { stiffness.flush(of, displacements == nullptr); });
    };
    int site = -1;
    for_each_tile(field, false, [&](const ParticleTile& tile, const Body& body) {
      if (averages_ && displacements == nullptr) at.dilatation.begin(model_.grid->shape().nodes());
      if (averages_ && displacements != nullptr) {
        find_dilatations(tile, body, frame, at);
        find_site_stress(tile, body, frame, at);
      }
      for_each_batch(tile, frame, Blocks::copies, at, [&](std::size_t) {
        Batch& batch = at.batch;
        if (displacements != nullptr) {
          take_strains(frame, body, at);
          if (linearised_) leave_yield_surface(batch);
          if (differences_)
            difference_tangent(*body.model, model_.options, batch,
                               at.copies.data() + batch_blocks * block_lanes * batch.layout->columns(),
                               at.stress_tangent);
          else
            body.model->tangent(batch, model_.options, at.stress_tangent);
          body.model->update(batch, model_.options);
          nodal_stress(strains(body, at), batch, at.stress);
          force_tangent(strains(body, at), batch, at.stress, at.stress_tangent, at.tangent);
          if (averages_) average_tangent(at);
        } else if (averages_) {
          touch_site_nodes(at);
        }
        for (int i = 0; i < batch.particles; ++i) {
          const Place& place = at.places[i / block_lanes];
          if (const int here = sites_of(place)[i % block_lanes]; here != site) {
            flush();
            site = here;
          }
          stiffness.begin_particle();
          S::for_each_node(
              place, i % block_lanes, inverse_cell,
              [&](int node, double, const Vec3<double>& slope) { stiffness.add_node(node, slope); });
          if (displacements != nullptr)
            stiffness.add_particle([&](int component) { return at.tangent.d[component][i]; });
        }
      });
      if (averages_) {
        flush();
        const double softness =
            matrix.keeps_products() ? softness_of(*body.model) : std::numeric_limits<double>::infinity();
        add_site_stiffness(at, displacements == nullptr, softness, with_matrix, flush);
      }
    });
    flush();
  });
}

}  // namespace mpm::core
