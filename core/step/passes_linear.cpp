#include "core/shape/linear.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/flip.hpp"

namespace mpm::core {

template class PassesWith<Linear, Flip>;
template class PassesWith<Linear, FlipPic>;

}  // namespace mpm::core
