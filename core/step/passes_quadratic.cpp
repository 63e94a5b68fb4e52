#include "core/shape/bspline.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/affine.hpp"

namespace mpm::core {

template class PassesWith<QuadraticBSpline, Flip>;
template class PassesWith<QuadraticBSpline, FlipPic>;
template class PassesWith<QuadraticBSpline, Apic>;
template class PassesWith<QuadraticBSpline, Tpic>;
template class PassesWith<QuadraticBSpline, Aflip>;

}  // namespace mpm::core
