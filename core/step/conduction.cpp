#include "core/step/conduction.hpp"

#include <algorithm>

#include "core/threads.hpp"

namespace mpm::core {

namespace {

constexpr int heat_doubles = record_doubles(NodeArray::second);
constexpr int flux_doubles = record_doubles(NodeArray::first);

bool conducts(const Body& body) { return body.model->conductivity() > 0; }

/// k/(rho c) of one particle.
double diffusivity(const Body& body, const double* block, int lane) {
  const ColumnLayout& layout = body.pool->layout();
  return body.model->conductivity() / body.model->specific_heat() *
         block[layout.offset(Column::volume) + lane] / block[layout.offset(Column::mass) + lane];
}

/// 1/dt_c of a diffusivity of one.
double sharpest_curvature(const GridGeometry& g) { return 2 * dot(g.inverse_cell, g.inverse_cell); }

}  // namespace

Conduction::Conduction(Model& model, Exchange& exchange)
    : model_(model), exchange_(exchange), shared_(model.grid->shape()) {
  any_ = std::ranges::any_of(model.bodies, conducts);
  if (!any_) return;
  heat_.resize(static_cast<std::size_t>(omp_get_max_threads()));
  flux_.resize(heat_.size());
  for (AlignedDoubles& a : heat_)
    a.resize(static_cast<std::size_t>(node_doubles * model.grid->shape().nodes()));
  for (AlignedDoubles& a : flux_)
    a.resize(static_cast<std::size_t>(node_doubles * model.grid->shape().nodes()));
}

template <class F>
void Conduction::for_each_block(Slot s, F f) const {
  const BrickGrid& grid = *model_.grid;
  const Brick& brick = grid.brick(s);
  const BrickFrame frame(grid.geometry(), grid.shape(), brick.coord);
  for (const Cohort& cohort : brick.cohorts) {
    const Body& body = model_.bodies[static_cast<std::size_t>(cohort.body)];
    if (!conducts(body)) continue;
    const ColumnLayout& layout = body.pool->layout();
    for (std::size_t b = 0; b < cohort.blocks.size(); ++b) {
      double* block = body.pool->block(cohort.blocks[b]);
      f(layout, body, block, BlockPlace(frame, layout, block), cohort.used_lanes(b));
    }
  }
}

void Conduction::map_heat() {
  BrickGrid& grid = *model_.grid;
  const auto map = [&](int slot) {
    const auto s = static_cast<Slot>(slot);
    double* to = grid.contributions(NodeArray::second, s);
    std::fill_n(to, heat_doubles * grid.shape().nodes(), 0.0);
    for_each_block(s, [&](const ColumnLayout& layout, const Body& body, const double* block,
                          const BlockPlace& place, int used) {
      const double c = body.model->specific_heat();
      for (int l = 0; l < used; ++l) {
        const double capacity = c * block[layout.offset(Column::mass) + l];
        const double heat = capacity * block[layout.offset(Column::temperature) + l];
        for_each_corner(place, l, grid.geometry().inverse_cell,
                        [&](int, int node, double shape, const Vec3<double>&) {
                          to[heat_doubles * node] += shape * capacity;
                          to[heat_doubles * node + 1] += shape * heat;
                        });
      }
    });
  };
  for_each_by_threads(0, grid.boundary(), 4, map);
  exchange_.begin_halo(grid, NodeArray::second, 0, 2);
  for_each_by_threads(grid.boundary(), grid.owned(), 4, map);
}

void Conduction::temperatures(Slot s, double* nodes) const {
  sum_contributions<NodeArray::second>(*model_.grid, shared_, s, nodes);
  for (int n = 0; n < shared_.nodes(); ++n) {
    double* at = nodes + node_doubles * n;
    at[1] = at[0] > 0 ? at[1] / at[0] : 0;
  }
}

void Conduction::map_flux() {
  BrickGrid& grid = *model_.grid;
  const auto map = [&](int slot) {
    const auto s = static_cast<Slot>(slot);
    double* nodes = heat_[static_cast<std::size_t>(omp_get_thread_num())].data();
    temperatures(s, nodes);
    double* to = grid.contributions(NodeArray::first, s);
    std::fill_n(to, flux_doubles * grid.shape().nodes(), 0.0);
    for_each_block(s, [&](const ColumnLayout& layout, const Body& body, const double* block,
                          const BlockPlace& place, int used) {
      for (int l = 0; l < used; ++l) {
        Vec3<double> gradient{};
        double unseen = block[layout.offset(Column::temperature) + l];
        for_each_corner(place, l, grid.geometry().inverse_cell,
                        [&](int, int node, double shape, const Vec3<double>& g) {
                          gradient = gradient + nodes[node_doubles * node + 1] * g;
                          unseen -= nodes[node_doubles * node + 1] * shape;
                        });
        const double heat = body.model->specific_heat() * block[layout.offset(Column::mass) + l] * unseen;
        const Vec3<double> flow =
            (-body.model->conductivity() * block[layout.offset(Column::volume) + l]) * gradient;
        for_each_corner(place, l, grid.geometry().inverse_cell,
                        [&](int, int node, double shape, const Vec3<double>& g) {
                          to[flux_doubles * node] += dot(flow, g);
                          to[flux_doubles * node + 1] += shape * heat;
                        });
      }
    });
  };
  for_each_by_threads(0, grid.boundary(), 4, map);
  exchange_.begin_halo(grid, NodeArray::first, 0, 2);
  for_each_by_threads(grid.boundary(), grid.owned(), 4, map);
}

void Conduction::warm(double dt) {
  BrickGrid& grid = *model_.grid;
  for_each_by_threads(0, grid.owned(), 4, [&](int slot) {
    const auto s = static_cast<Slot>(slot);
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    double *nodes = heat_[thread].data(), *flux = flux_[thread].data();
    temperatures(s, nodes);
    sum_contributions<NodeArray::first>(grid, shared_, s, flux);
    for (int n = 0; n < shared_.nodes(); ++n) {  // to the nodes' rise, and P T'
      const double capacity = nodes[node_doubles * n];
      double* at = flux + node_doubles * n;
      at[0] = capacity > 0 ? dt * at[0] / capacity : 0;
      at[1] = capacity > 0 ? at[1] / capacity : 0;
    }
    const double curvature = sharpest_curvature(grid.geometry());
    for_each_block(s, [&](const ColumnLayout& layout, const Body& body, double* block,
                          const BlockPlace& place, int used) {
      const double per_volume = body.model->reference_density() * body.model->specific_heat();
      for (int l = 0; l < used; ++l) {
        double rise = 0, unseen = block[layout.offset(Column::temperature) + l];
        for_each_corner(place, l, grid.geometry().inverse_cell,
                        [&](int, int node, double shape, const Vec3<double>&) {
                          rise += shape * flux[node_doubles * node];
                          unseen -= shape * (nodes[node_doubles * node + 1] + flux[node_doubles * node + 1]);
                        });
        rise -= std::min(diffusivity(body, block, l) * curvature * dt, 1.0) * unseen;
        block[layout.offset(Column::temperature) + l] += rise;
        block[layout.offset(Column::internal_energy) + l] += per_volume * rise;
      }
    });
  });
}

double conduction_step(const Model& model) {
  double most = 0;
  if (std::ranges::any_of(model.bodies, conducts)) {
    core::for_each_block(model, [&](int number, const ColumnLayout&, const double* block, int used) {
      const Body& body = model.bodies[static_cast<std::size_t>(number)];
      if (!conducts(body)) return;
      for (int l = 0; l < used; ++l) most = std::max(most, diffusivity(body, block, l));
    });
  }
  return 1 / (most * sharpest_curvature(model.grid->geometry()));
}

}  // namespace mpm::core
