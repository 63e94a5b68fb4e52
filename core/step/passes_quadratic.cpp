#include "core/shape/bspline.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/affine.hpp"

namespace mpm::core {

template std::unique_ptr<Passes> make_passes_with<QuadraticBSpline, Flip>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<QuadraticBSpline, FlipPic>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<QuadraticBSpline, Apic>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<QuadraticBSpline, Tpic>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<QuadraticBSpline, Aflip>(Model&, NodeHalo&, RigidBodies*);

}  // namespace mpm::core
