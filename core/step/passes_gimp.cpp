#include "core/shape/gimp.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/flip.hpp"

namespace mpm::core {

template class PassesWith<UniformGimp, Flip>;
template class PassesWith<ContiguousGimp, Flip>;

}  // namespace mpm::core
