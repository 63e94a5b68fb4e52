// What particles give the nodes once, before an implicit step is solved: mass, momentum and external forces,
// prescribed motion and stiffness, and the lag of the acceleration. Part of implicit_passes_with.hpp.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/implicit/implicit_passes_with.hpp"
#include "core/step/load_forces.hpp"

namespace mpm::core {

template <ShapePolicy S>
void ImplicitPassesWith<S>::map_start() {
  const Vec3<double> inverse_cell = model_.grid->geometry().inverse_cell;
  const Vec3<double> cell = model_.grid->geometry().cell;
  for_fields([&](const BrickField& field, Scratch&) {
    const BrickFrame frame(*model_.grid, field.slot, field.number);
    double* const contributions = clear_contributions(field);
    for_each_block(
        field, false, [&](const ParticleTile& tile, const ColumnLayout& layout, double* block, int used) {
          const Place place(frame, layout, block, used);
          const Vec3<double> weight = gravity_ + loads_.acceleration(tile.body);  // per mass
          for (int l = 0; l < used; ++l) {
            const double m = block[layout.offset(Column::mass) + l];
            double per_shape[8] = {0, 0, 0, m, m * weight.x, m * weight.y, m * weight.z, 1};
            for (int a = 0; a < 3; ++a)
              per_shape[a] = m * block[layout.offset(next(Column::velocity_x, a)) + l];
            S::for_each_node(place, l, inverse_cell, [&](int node, double shape, const Vec3<double>& slope) {
              double* to = contributions + node_doubles * node;
              for (int i = 0; i < node_doubles; ++i) to[i] += shape * per_shape[i];
              to[7] += std::abs(slope.x) * cell.x + std::abs(slope.y) * cell.y + std::abs(slope.z) * cell.z;
            });
          }
          if (loads_.act(*model_.grid, field.slot, tile.body))
            add_load_forces<S>(loads_, model_, field.slot, tile.body, {}, place, block, used, contributions);
        });
    fold(mapped::implicit_start, field, contributions);
  });
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::map_motion() {
  const Vec3<double> inverse_cell = model_.grid->geometry().inverse_cell;
  for_fields([&](const BrickField& field, Scratch&) {
    const BrickFrame frame(*model_.grid, field.slot, field.number);
    double* const contributions = clear_contributions(field);
    for_each_block(
        field, false, [&](const ParticleTile& tile, const ColumnLayout& layout, double* block, int used) {
          const Place place(frame, layout, block, used);
          const bool moved = prescribed(tile.body);
          const ConstitutiveModel& material = *model_.bodies[static_cast<std::size_t>(tile.body)].model;
          const double c = material.initial_sound_speed(), shear = material.initial_shear_speed();
          // Nodes of cells cut by a surface can move without changing volumes, and a nearly incompressible
          // material should not hinder that with a share of its bulk modulus.
          const double modulus =
              material.reference_density() * (shear > 0 ? std::min(c * c, 4 * shear * shear) : c * c);
          for (int l = 0; l < used; ++l) {
            const double volume = block[layout.offset(Column::volume) + l];
            double per_shape[7] = {0, 0, 0, 0, volume, volume * modulus, modulus > 0 ? volume / modulus : 0};
            if (moved) {
              const Vec3<double> v = loads_.motion(tile.body).velocity.velocity(block + l);
              for (int a = 0; a < 3; ++a) per_shape[a] = volume * v[a];
              per_shape[3] = volume;
            }
            for_each_weight<S>(place, l, inverse_cell, [&](int node, double shape) {
              for (int i = 0; i < 7; ++i) contributions[node_doubles * node + i] += shape * per_shape[i];
            });
          }
        });
    fold(mapped::implicit_motion, field, contributions);
  });
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::map_surface() {
  const Vec3<double> inverse_cell = model_.grid->geometry().inverse_cell;
  for_fields([&](const BrickField& field, Scratch&) {
    const BrickFrame frame(*model_.grid, field.slot, field.number);
    double* const contributions = clear_contributions(field);
    const auto map = [&](const ParticleTile& tile, const ColumnLayout& layout, const double* block,
                         int used) {
      if (field.component == all_components && gives_nothing(tile.body)) return;
      const Place place(frame, layout, block, used);
      for (int l = 0; l < used; ++l) {
        const double volume = block[layout.offset(Column::volume) + l];
        S::for_each_node(place, l, inverse_cell, [&](int node, double shape, const Vec3<double>& slope) {
          double* to = contributions + node_doubles * node;
          for (int a = 0; a < 3; ++a) to[a] += volume * slope[a];
          to[node_field::mass.first] += volume * shape;
        });
      }
    };
    for_each_block(field, true, map);
    fold(mapped::implicit_surface, field, contributions);
  });
}

/// Vectors of particles, by vector(tile, layout, lane), in the place of the momentum; of the tiles that have
/// any, by has(tile, layout). Column c of a particle is lane[layout.offset(c)].
template <ShapePolicy S>
template <class Has, class F>
void ImplicitPassesWith<S>::map_vectors(Has has, F vector) {
  const Vec3<double> inverse_cell = model_.grid->geometry().inverse_cell;
  for_fields([&](const BrickField& field, Scratch&) {
    const BrickFrame frame(*model_.grid, field.slot, field.number);
    double* const contributions = clear_contributions(field);
    for_each_block(field, false,
                   [&](const ParticleTile& tile, const ColumnLayout& layout, double* block, int used) {
                     if (!has(tile, layout)) return;
                     const Place place(frame, layout, block, used);
                     for (int l = 0; l < used; ++l) {
                       const Vec3<double> mine = vector(tile, layout, block + l);
                       for_each_weight<S>(place, l, inverse_cell, [&](int node, double shape) {
                         for (int a = 0; a < 3; ++a)
                           contributions[node_doubles * node + a] += shape * mine[a];
                       });
                     }
                   });
    fold(mapped::implicit_lag, field, contributions);
  });
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::map_lag() {
  const auto has = [](const ParticleTile&, const ColumnLayout& layout) {
    return layout.has(Column::acceleration_lag_x);
  };
  map_vectors(has, [&](const ParticleTile&, const ColumnLayout& layout, const double* lane) {
    const double m = lane[layout.offset(Column::mass)];
    Vec3<double> lag;
    for (int a = 0; a < 3; ++a) lag[a] = m * dt_ * lane[layout.offset(next(Column::acceleration_lag_x, a))];
    return lag;
  });
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::map_drive() {
  const auto has = [&](const ParticleTile& tile, const ColumnLayout&) { return prescribed(tile.body); };
  map_vectors(has, [&](const ParticleTile& tile, const ColumnLayout& layout, const double* lane) {
    const auto get = [&](Column c) { return lane[layout.offset(c)]; };
    const Vec3<double> v{get(Column::velocity_x), get(Column::velocity_y), get(Column::velocity_z)};
    return get(Column::volume) * (loads_.motion(tile.body).velocity.velocity(lane) - v);
  });
}

/// The impulse on a node acts on the bodies that hold it by their volumes there.
template <ShapePolicy S>
void ImplicitPassesWith<S>::add_reactions(const AlignedDoubles& impulses) {
  const GridGeometry& g = model_.grid->geometry();
  for_fields([&](const BrickField& field, Scratch& at) {
    const BrickFrame frame(*model_.grid, field.slot, field.number);
    const BrickCoord brick = model_.grid->brick(field.slot).coord;
    const double* of_nodes = records(impulses, field);
    for_each_block(
        field, true, [&](const ParticleTile& tile, const ColumnLayout& layout, double* block, int used) {
          if (!prescribed(tile.body) || rigid(tile.body) >= 0) return;
          const bool at_faces = gives_nothing(tile.body);  // body_faces.hpp has its forces
          const Place place(frame, layout, block, used);
          double mass = 0;
          Vec3<double> impulse{}, moment{}, mass_place{};
          for (int l = 0; l < used; ++l) {
            const auto get = [&](Column c) { return block[layout.offset(c) + l]; };
            const double volume = get(Column::volume), m = get(Column::mass);
            mass += m;
            for (int a = 0; a < 3; ++a) mass_place[a] += m * get(next(Column::position_x, a));
            if (at_faces) continue;
            for_each_weight<S>(place, l, g.inverse_cell, [&](int node, double shape) {
              const double* v = MotionRecord<const double>{of_nodes + node_doubles * node}.velocity();
              const Vec3<double> given = (volume * shape) * Vec3<double>{v[0], v[1], v[2]};
              if (given == Vec3<double>{}) return;
              impulse = impulse + given;
              moment = moment + cross(g.node_place(brick, model_.grid->shape().node(node)), given);
            });
          }
          ReactionSums& sums = reaction_of(tile.body, at);
          sums.sums[ReactionSums::mass].add(mass);
          sums.add(ReactionSums::place, mass_place);
          sums.add(ReactionSums::impulse, impulse);
          sums.add(ReactionSums::moment, moment);
        });
  });
}

}  // namespace mpm::core
