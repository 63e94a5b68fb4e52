#include "core/shape/bspline.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/affine.hpp"

namespace mpm::core {

template class PassesWith<CubicBSpline, Flip>;
template class PassesWith<CubicBSpline, FlipPic>;
template class PassesWith<CubicBSpline, Apic>;
template class PassesWith<CubicBSpline, Tpic>;
template class PassesWith<CubicBSpline, Aflip>;

}  // namespace mpm::core
