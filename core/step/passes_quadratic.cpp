#include "core/shape/bspline.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/affine.hpp"

namespace mpm::core {

template std::unique_ptr<Passes> make_passes_with<QuadraticBSpline, Flip>(Model&, NodeHalo&);
template std::unique_ptr<Passes> make_passes_with<QuadraticBSpline, FlipPic>(Model&, NodeHalo&);
template std::unique_ptr<Passes> make_passes_with<QuadraticBSpline, Apic>(Model&, NodeHalo&);
template std::unique_ptr<Passes> make_passes_with<QuadraticBSpline, Tpic>(Model&, NodeHalo&);
template std::unique_ptr<Passes> make_passes_with<QuadraticBSpline, Aflip>(Model&, NodeHalo&);

}  // namespace mpm::core
