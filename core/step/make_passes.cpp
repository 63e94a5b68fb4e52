// The only place where a run's shape functions and transfer are chosen.
#include "core/shape/list.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/flip.hpp"

namespace mpm::core {

// Compiled one by one, in passes_<shape>.cpp.
extern template class PassesWith<Linear, Flip>;
extern template class PassesWith<Sgmp, Flip>;
extern template class PassesWith<UniformGimp, Flip>;
extern template class PassesWith<ContiguousGimp, Flip>;
extern template class PassesWith<QuadraticBSpline, Flip>;
extern template class PassesWith<CubicBSpline, Flip>;

std::unique_ptr<Passes> make_passes(Model& model, NodeHalo& halo) {
  return with_shape(model.scene->grid.shape, [&]<class S>(std::type_identity<S>) -> std::unique_ptr<Passes> {
    return std::make_unique<PassesWith<S, Flip>>(model, halo);
  });
}

ColumnSet shape_columns(const Scene& scene) {
  return with_shape(scene.grid.shape, []<class S>(std::type_identity<S>) { return S::columns(); });
}

ColumnSet transfer_columns(const Scene&) { return Flip::columns(); }

Site site_of(const Scene& scene) {
  return with_shape(scene.grid.shape, []<class S>(std::type_identity<S>) { return S::site; });
}

NodeBlockShape node_block_of(const Scene& scene) {
  return with_shape(scene.grid.shape, []<class S>(std::type_identity<S>) { return S::node_block; });
}

NodeArraySet node_arrays_of(const Scene& scene, bool conducts) {
  NodeArraySet arrays{NodeArray::first};
  if (conducts || scene.solution.scheme != Scheme::usl) arrays.add(NodeArray::second);
  return arrays;
}

}  // namespace mpm::core
