#include "core/shape/gimp.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/affine.hpp"

namespace mpm::core {

template class PassesWith<UniformGimp, Flip>;
template class PassesWith<UniformGimp, FlipPic>;
template class PassesWith<UniformGimp, Apic>;
template class PassesWith<UniformGimp, Tpic>;
template class PassesWith<UniformGimp, Aflip>;

}  // namespace mpm::core
