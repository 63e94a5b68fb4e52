#include "core/implicit/implicit_passes_with.hpp"
#include "core/shape/list.hpp"

namespace mpm::core {

std::unique_ptr<ImplicitPasses> make_implicit_passes(Model& model, const RigidBodies* rigid,
                                                     std::span<const int> with_faces,
                                                     const BrickFields& fields) {
  using Made = std::unique_ptr<ImplicitPasses>;
  return with_shape(model.scene->grid.shape, [&]<class S>(std::type_identity<S>) -> Made {
    return std::make_unique<ImplicitPassesWith<S>>(model, rigid, with_faces, fields);
  });
}

}  // namespace mpm::core
