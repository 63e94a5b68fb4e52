// The only place where a run's shape functions and transfer are chosen.
#include "core/step/pass_traits.hpp"
#include "core/step/passes.hpp"
#include "core/transfer/list.hpp"

namespace mpm::core {

std::unique_ptr<Passes> make_passes(Model& model, NodeHalo& halo, RigidBodies* rigid) {
  using Made = std::unique_ptr<Passes>;
  return with_shape(model.scene->grid.shape, [&]<class S>(std::type_identity<S>) -> Made {
    return with_transfer<S>(model.scene->solution, [&]<class T>(std::type_identity<T>) -> Made {
      return make_passes_with<S, T>(model, halo, rigid);
    });
  });
}

ColumnSet shape_columns(const Scene& scene) {
  return with_shape(scene.grid.shape, []<class S>(std::type_identity<S>) { return S::columns(); });
}

ColumnSet transfer_columns(const Scene& scene) {
  return with_shape(scene.grid.shape, [&]<class S>(std::type_identity<S>) {
    return with_transfer<S>(scene.solution, []<class T>(std::type_identity<T>) { return T::columns(); });
  });
}

bool affine_transfers_go_with(ShapeFunction shape) {
  return with_known_shape(shape, []<class S>(std::type_identity<S>) { return affine_with<S>; });
}

bool consistent_mass_goes_with(ShapeFunction shape) {
  return with_known_shape(shape, []<class S>(std::type_identity<S>) { return consistent_mass_with<S>; });
}

Site site_of(const Scene& scene) {
  return with_shape(scene.grid.shape, []<class S>(std::type_identity<S>) { return S::site; });
}

NodeBlockShape node_block_of(const Scene& scene) {
  return with_shape(scene.grid.shape, []<class S>(std::type_identity<S>) { return S::node_block; });
}

int product_doubles_of(const Scene& scene) {
  const SolutionInput& solution = scene.solution;
  const int vectors = solution.mass == MassMatrix::consistent ? 2 : is_corrected(solution.transfer) ? 1 : 0;
  return with_shape(scene.grid.shape, [&]<class S>(std::type_identity<S>) {
    const int moments = multiplies_by_cells<S>(solution) ? cell_mass::brick_doubles : 0;
    return vectors * node_doubles * S::node_block.nodes() + moments;
  });
}

NodeArraySet node_arrays_of(const Scene& scene, Scheme scheme, bool conducts) {
  NodeArraySet arrays{NodeArray::first};
  if (conducts || maps_back(scheme)) arrays.add(NodeArray::second);
  if (orders_of(scene.solution) > 1 || scene.solution.mass == MassMatrix::consistent)
    arrays.add(NodeArray::third);
  if (scene.contact.enable) arrays.add(NodeArray::fourth);
  if (scene.contact.measures_gaps()) arrays.add(NodeArray::fifth);
  if (strains_first(scheme)) {
    arrays.add(NodeArray::sixth);
    if (scene.grid.has_face(Boundary::rigid_wall)) arrays.add(NodeArray::seventh);
  }
  return arrays;
}

}  // namespace mpm::core
