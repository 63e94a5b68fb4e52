#include "core/step/conduction.hpp"

#include <algorithm>

#include "core/particle_range.hpp"
#include "core/shape/list.hpp"
#include "core/step/node_update.hpp"
#include "core/step/shared_nodes.hpp"
#include "core/threads.hpp"

namespace mpm::core {

namespace {

constexpr int heat_doubles = record_doubles(mapped::heat.array);
constexpr int flow_doubles = record_doubles(mapped::heat_flow.array);

bool conducts(const Body& body) { return body.model->conductivity() > 0; }

/// k/(rho c) of one particle.
double diffusivity(const Body& body, const double* block, int lane) {
  const ColumnLayout& layout = body.pool->layout();
  return body.model->conductivity() / body.model->specific_heat() *
         block[layout.offset(Column::volume) + lane] / block[layout.offset(Column::mass) + lane];
}

/// 1/dt_c for unit diffusivity.
double sharpest_curvature(const GridGeometry& g) { return 2 * dot(g.inverse_cell, g.inverse_cell); }

/// R, dt/dt_c of one particle. Above 1, in a step longer than the critical one, the decay would overshoot.
double decay(const Body& body, const double* block, int lane, const GridGeometry& g, double dt) {
  return std::min(diffusivity(body, block, lane) * sharpest_curvature(g) * dt, 1.0);
}

template <ShapePolicy S>
class ConductionWith final : public Conduction {
 public:
  ConductionWith(Model& model, NodeHalo& halo);
  bool any() const override { return any_; }
  void map_heat() override;
  void map_flux(double dt) override;
  void update_temperatures(double dt) override;
  void finish_exchange() override { halo_.end(*model_.grid); }

 private:
  /// f(layout, body, block, place, lanes in use) for the blocks of the bodies that conduct.
  template <class F>
  void for_each_block(Slot s, F f) const;
  BoundaryFaces faces(Slot s) const { return {*model_.grid, s}; }
  /// Capacity and temperature of the brick's nodes, in components 0 and 1.
  void temperatures(Slot s, double* nodes) const;

  Model& model_;
  NodeHalo& halo_;
  SharedNodes shared_;
  std::vector<AlignedDoubles> heat_, flow_;  ///< of the current brick, by thread
  bool any_ = false;
};

template <ShapePolicy S>
ConductionWith<S>::ConductionWith(Model& model, NodeHalo& halo)
    : model_(model), halo_(halo), shared_(model.grid->shape()), any_(conducts_heat(model)) {
  if (!any_) return;
  heat_.resize(static_cast<std::size_t>(omp_get_max_threads()));
  flow_.resize(heat_.size());
  for (AlignedDoubles& a : heat_)
    a.resize(static_cast<std::size_t>(node_doubles * model.grid->shape().nodes()));
  for (AlignedDoubles& a : flow_)
    a.resize(static_cast<std::size_t>(node_doubles * model.grid->shape().nodes()));
}

template <ShapePolicy S>
template <class F>
void ConductionWith<S>::for_each_block(Slot s, F f) const {
  const BrickGrid& grid = *model_.grid;
  const Brick& brick = grid.brick(s);
  const BrickFrame frame(grid, s);
  for (const ParticleBlock& block : blocks_of(model_, brick)) {
    const Body& body = model_.bodies[static_cast<std::size_t>(block.body)];
    if (conducts(body))
      f(*block.layout, body, block.data, typename S::Place(frame, *block.layout, block.data, block.used),
        block.used);
  }
}

template <ShapePolicy S>
void ConductionWith<S>::map_heat() {
  BrickGrid& grid = *model_.grid;
  const auto map = [&](int slot) {
    const auto s = static_cast<Slot>(slot);
    double* to = grid.contributions(mapped::heat.array, s);
    std::fill_n(to, heat_doubles * grid.shape().nodes(), 0.0);
    for_each_block(s, [&](const ColumnLayout& layout, const Body& body, const double* block,
                          const typename S::Place& place, int used) {
      const double c = body.model->specific_heat();
      for (int l = 0; l < used; ++l) {
        const double capacity = c * block[layout.offset(Column::mass) + l];
        const double heat = capacity * block[layout.offset(Column::temperature) + l];
        for_each_weight<S>(place, l, grid.geometry().inverse_cell, [&](int node, double shape) {
          to[heat_doubles * node] += shape * capacity;
          to[heat_doubles * node + 1] += shape * heat;
        });
      }
    });
    faces(s).fold(mapped::heat, to);
  };
  for_each_by_threads(0, grid.boundary(), 4, map);
  halo_.begin(grid, mapped::heat);
  for_each_by_threads(grid.boundary(), grid.owned(), 4, map);
}

template <ShapePolicy S>
void ConductionWith<S>::temperatures(Slot s, double* nodes) const {
  sum_contributions<mapped::heat.array>(*model_.grid, shared_, s, nodes);
  for (int n = 0; n < shared_.nodes(); ++n) {
    double* at = nodes + node_doubles * n;
    at[1] = at[0] > 0 ? at[1] / at[0] : 0;
  }
  faces(s).mirror(1, nodes);
}

template <ShapePolicy S>
void ConductionWith<S>::map_flux(double dt) {
  BrickGrid& grid = *model_.grid;
  const auto map = [&](int slot) {
    const auto s = static_cast<Slot>(slot);
    double* nodes = heat_[static_cast<std::size_t>(omp_get_thread_num())].data();
    temperatures(s, nodes);
    double* to = grid.contributions(mapped::heat_flow.array, s);
    std::fill_n(to, flow_doubles * grid.shape().nodes(), 0.0);
    for_each_block(s, [&](const ColumnLayout& layout, const Body& body, const double* block,
                          const typename S::Place& place, int used) {
      for (int l = 0; l < used; ++l) {
        Vec3<double> gradient{};
        double unseen = block[layout.offset(Column::temperature) + l];
        S::for_each_node(place, l, grid.geometry().inverse_cell,
                         [&](int node, double shape, const Vec3<double>& g) {
                           gradient = gradient + nodes[node_doubles * node + 1] * g;
                           unseen -= nodes[node_doubles * node + 1] * shape;
                         });
        const double decaying = body.model->specific_heat() * block[layout.offset(Column::mass) + l] *
                                decay(body, block, l, grid.geometry(), dt) * unseen;
        const Vec3<double> flow =
            (-body.model->conductivity() * block[layout.offset(Column::volume) + l]) * gradient;
        S::for_each_node(place, l, grid.geometry().inverse_cell,
                         [&](int node, double shape, const Vec3<double>& g) {
                           to[flow_doubles * node] += dot(flow, g);
                           to[flow_doubles * node + 1] += shape * decaying;
                         });
      }
    });
    faces(s).fold(mapped::heat_flow, to);
  };
  for_each_by_threads(0, grid.boundary(), 4, map);
  halo_.begin(grid, mapped::heat_flow);
  for_each_by_threads(grid.boundary(), grid.owned(), 4, map);
}

template <ShapePolicy S>
void ConductionWith<S>::update_temperatures(double dt) {
  BrickGrid& grid = *model_.grid;
  for_each_by_threads(0, grid.owned(), 4, [&](int slot) {
    const auto s = static_cast<Slot>(slot);
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    double *nodes = heat_[thread].data(), *flux = flow_[thread].data();
    temperatures(s, nodes);
    sum_contributions<mapped::heat_flow.array>(grid, shared_, s, flux);
    for (int n = 0; n < shared_.nodes(); ++n) {  // increments dT_i, and P R T'
      const double capacity = nodes[node_doubles * n];
      double* at = flux + node_doubles * n;
      at[0] = capacity > 0 ? dt * at[0] / capacity : 0;
      at[1] = capacity > 0 ? at[1] / capacity : 0;
    }
    for (const int component : {0, 1}) faces(s).mirror(component, flux);
    for_each_block(s, [&](const ColumnLayout& layout, const Body& body, double* block,
                          const typename S::Place& place, int used) {
      const double per_volume = body.model->reference_density() * body.model->specific_heat();
      for (int l = 0; l < used; ++l) {
        double rise = 0, unseen = block[layout.offset(Column::temperature) + l];
        for_each_weight<S>(place, l, grid.geometry().inverse_cell, [&](int node, double shape) {
          rise += shape * (flux[node_doubles * node] + flux[node_doubles * node + 1]);
          unseen -= shape * nodes[node_doubles * node + 1];
        });
        rise -= decay(body, block, l, grid.geometry(), dt) * unseen;
        block[layout.offset(Column::temperature) + l] += rise;
        block[layout.offset(Column::internal_energy) + l] += per_volume * rise;
      }
    });
  });
}

}  // namespace

std::unique_ptr<Conduction> make_conduction(Model& model, NodeHalo& halo) {
  return with_shape(model.scene->grid.shape,
                    [&]<class S>(std::type_identity<S>) -> std::unique_ptr<Conduction> {
                      return std::make_unique<ConductionWith<S>>(model, halo);
                    });
}

bool conducts_heat(const Model& model) { return std::ranges::any_of(model.bodies, conducts); }

double conduction_step(const Model& model) {
  double most = 0;
  if (std::ranges::any_of(model.bodies, conducts)) {
    for (const ConstParticleBlock& block : blocks_of(model)) {
      const Body& body = model.bodies[static_cast<std::size_t>(block.body)];
      if (!conducts(body)) continue;
      for (int l = 0; l < block.used; ++l) most = std::max(most, diffusivity(body, block.data, l));
    }
  }
  return 1 / (most * sharpest_curvature(model.grid->geometry()));
}

}  // namespace mpm::core
