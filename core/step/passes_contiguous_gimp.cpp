#include "core/shape/gimp.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/affine.hpp"

namespace mpm::core {

template class PassesWith<ContiguousGimp, Flip>;
template class PassesWith<ContiguousGimp, FlipPic>;
template class PassesWith<ContiguousGimp, Apic>;
template class PassesWith<ContiguousGimp, Tpic>;
template class PassesWith<ContiguousGimp, Aflip>;

}  // namespace mpm::core
