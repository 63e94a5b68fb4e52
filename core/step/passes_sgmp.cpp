#include "core/shape/sgmp.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/flip.hpp"

namespace mpm::core {

template class PassesWith<Sgmp, Flip>;
template class PassesWith<Sgmp, FlipPic>;

}  // namespace mpm::core
