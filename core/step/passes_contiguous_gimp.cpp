#include "core/shape/gimp.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/affine.hpp"

namespace mpm::core {

template std::unique_ptr<Passes> make_passes_with<ContiguousGimp, Flip>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<ContiguousGimp, FlipPic>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<ContiguousGimp, Apic>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<ContiguousGimp, Tpic>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<ContiguousGimp, Aflip>(Model&, NodeHalo&, RigidBodies*);

}  // namespace mpm::core
