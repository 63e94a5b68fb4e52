#include "core/shape/bspline.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/flip.hpp"

namespace mpm::core {

template class PassesWith<QuadraticBSpline, Flip>;
template class PassesWith<CubicBSpline, Flip>;

}  // namespace mpm::core
