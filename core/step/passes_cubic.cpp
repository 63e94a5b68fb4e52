#include "core/shape/bspline.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/affine.hpp"

namespace mpm::core {

template std::unique_ptr<Passes> make_passes_with<CubicBSpline, Flip>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<CubicBSpline, FlipPic>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<CubicBSpline, Apic>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<CubicBSpline, Tpic>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<CubicBSpline, Aflip>(Model&, NodeHalo&, RigidBodies*);

}  // namespace mpm::core
