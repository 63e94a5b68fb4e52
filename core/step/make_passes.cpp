// The only place where a run's shape functions and transfer are chosen.
#include "core/step/passes_with.hpp"
#include "core/transfer/list.hpp"

namespace mpm::core {

// Compiled one family at a time, in passes_<shape>.cpp.
#define MPM_PASSES(S)                        \
  extern template class PassesWith<S, Flip>; \
  extern template class PassesWith<S, FlipPic>
#define MPM_AFFINE_PASSES(S)                 \
  extern template class PassesWith<S, Apic>; \
  extern template class PassesWith<S, Tpic>; \
  extern template class PassesWith<S, Aflip>
MPM_PASSES(Linear);
MPM_PASSES(Sgmp);
MPM_PASSES(UniformGimp);
MPM_AFFINE_PASSES(UniformGimp);
MPM_PASSES(ContiguousGimp);
MPM_AFFINE_PASSES(ContiguousGimp);
MPM_PASSES(QuadraticBSpline);
MPM_AFFINE_PASSES(QuadraticBSpline);
MPM_PASSES(CubicBSpline);
MPM_AFFINE_PASSES(CubicBSpline);

std::unique_ptr<Passes> make_passes(Model& model, NodeHalo& halo) {
  using Made = std::unique_ptr<Passes>;
  return with_shape(model.scene->grid.shape, [&]<class S>(std::type_identity<S>) -> Made {
    return with_transfer<S>(model.scene->solution, [&]<class T>(std::type_identity<T>) -> Made {
      return std::make_unique<PassesWith<S, T>>(model, halo);
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
