#include "core/shape/gimp.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/affine.hpp"

namespace mpm::core {

template std::unique_ptr<Passes> make_passes_with<UniformGimp, Flip>(Model&, NodeHalo&);
template std::unique_ptr<Passes> make_passes_with<UniformGimp, FlipPic>(Model&, NodeHalo&);
template std::unique_ptr<Passes> make_passes_with<UniformGimp, Apic>(Model&, NodeHalo&);
template std::unique_ptr<Passes> make_passes_with<UniformGimp, Tpic>(Model&, NodeHalo&);
template std::unique_ptr<Passes> make_passes_with<UniformGimp, Aflip>(Model&, NodeHalo&);

}  // namespace mpm::core
