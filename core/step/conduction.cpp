#include "core/step/conduction.hpp"

#include <algorithm>
#include <limits>

#include "core/threads.hpp"

namespace mpm::core {

namespace {

constexpr int heat_doubles = record_doubles(NodeArray::second);
constexpr int flux_doubles = record_doubles(NodeArray::first);

/// f(node, S, gradient of S) for the nodes of a lane's cell.
template <class F>
void for_each_node(const GridGeometry& g, const BlockPlace& place, int lane, F f) {
  const double x = place.f[0][lane], y = place.f[1][lane], z = place.f[2][lane];
  const double wx[2] = {1 - x, x}, wy[2] = {1 - y, y}, wz[2] = {1 - z, z};
  for (int n = 0; n < 8; ++n) {
    const int i = n & 1, j = (n >> 1) & 1, k = n >> 2;
    f(place.node[lane] + corner_node(n), wx[i] * wy[j] * wz[k],
      Vec3<double>{(2 * i - 1) * g.inverse_cell.x * wy[j] * wz[k],
                   (2 * j - 1) * g.inverse_cell.y * wx[i] * wz[k],
                   (2 * k - 1) * g.inverse_cell.z * wx[i] * wy[j]});
  }
}

}  // namespace

Conduction::Conduction(Model& model, Exchange& exchange)
    : model_(model), exchange_(exchange), shared_(model.grid->shape()) {
  any_ = std::ranges::any_of(model.bodies, [](const Body& b) { return b.model->conductivity() > 0; });
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
    if (!(body.model->conductivity() > 0)) continue;
    const ColumnLayout& layout = body.pool->layout();
    for (std::size_t b = 0; b < cohort.blocks.size(); ++b) {
      double* block = body.pool->block(cohort.blocks[b]);
      f(layout, body, block, BlockPlace(frame, layout, block),
        static_cast<int>(std::min<std::size_t>(block_lanes, cohort.count - block_lanes * b)));
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
        for_each_node(grid.geometry(), place, l, [&](int node, double shape, const Vec3<double>&) {
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
        for_each_node(grid.geometry(), place, l, [&](int node, double, const Vec3<double>& g) {
          gradient = gradient + nodes[node_doubles * node + 1] * g;
        });
        const Vec3<double> flow =
            (-body.model->conductivity() * block[layout.offset(Column::volume) + l]) * gradient;
        for_each_node(grid.geometry(), place, l, [&](int node, double, const Vec3<double>& g) {
          to[flux_doubles * node] += dot(flow, g);
        });
      }
    });
  };
  for_each_by_threads(0, grid.boundary(), 4, map);
  exchange_.begin_halo(grid, NodeArray::first, 0, 1);
  for_each_by_threads(grid.boundary(), grid.owned(), 4, map);
}

void Conduction::warm(double dt) {
  BrickGrid& grid = *model_.grid;
  for_each_by_threads(0, grid.owned(), 4, [&](int slot) {
    const auto s = static_cast<Slot>(slot);
    const auto thread = static_cast<std::size_t>(omp_get_thread_num());
    double *nodes = heat_[thread].data(), *flux = flux_[thread].data();
    sum_contributions<NodeArray::second>(grid, shared_, s, nodes);
    sum_contributions<NodeArray::first>(grid, shared_, s, flux);
    for (int n = 0; n < shared_.nodes(); ++n) {
      const double capacity = nodes[node_doubles * n];
      flux[node_doubles * n] = capacity > 0 ? dt * flux[node_doubles * n] / capacity : 0;
    }
    for_each_block(s, [&](const ColumnLayout& layout, const Body& body, double* block,
                          const BlockPlace& place, int used) {
      const double per_volume = body.model->reference_density() * body.model->specific_heat();
      for (int l = 0; l < used; ++l) {
        double rise = 0;
        for_each_node(grid.geometry(), place, l, [&](int node, double shape, const Vec3<double>&) {
          rise += shape * flux[node_doubles * node];
        });
        block[layout.offset(Column::temperature) + l] += rise;
        block[layout.offset(Column::internal_energy) + l] += per_volume * rise;
      }
    });
  });
}

double Conduction::critical_step() const {
  if (!any_) return std::numeric_limits<double>::infinity();
  const GridGeometry& g = model_.grid->geometry();
  const double curvature = dot(g.inverse_cell, g.inverse_cell);
  double diffusivity = 0;
  core::for_each_block(model_, [&](int body, const ColumnLayout& layout, const double* block, int used) {
    const ConstitutiveModel& m = *model_.bodies[static_cast<std::size_t>(body)].model;
    if (!(m.conductivity() > 0)) return;
    for (int l = 0; l < used; ++l) {
      diffusivity = std::max(diffusivity, m.conductivity() / m.specific_heat() *
                                              block[layout.offset(Column::volume) + l] /
                                              block[layout.offset(Column::mass) + l]);
    }
  });
  return 1 / (2 * diffusivity * curvature);
}

}  // namespace mpm::core
