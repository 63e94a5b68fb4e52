#include "core/shape/gimp.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/affine.hpp"

namespace mpm::core {

template std::unique_ptr<Passes> make_passes_with<UniformGimp, Flip>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<UniformGimp, FlipPic>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<UniformGimp, Apic>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<UniformGimp, Tpic>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<UniformGimp, Aflip>(Model&, NodeHalo&, RigidBodies*);

}  // namespace mpm::core
