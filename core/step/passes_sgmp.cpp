#include "core/shape/sgmp.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/flip.hpp"

namespace mpm::core {

template std::unique_ptr<Passes> make_passes_with<Sgmp, Flip>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<Sgmp, FlipPic>(Model&, NodeHalo&, RigidBodies*);

}  // namespace mpm::core
