#include "core/shape/sgmp.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/corrected.hpp"

namespace mpm::core {

template std::unique_ptr<Passes> make_passes_with<Sgmp, Flip>(Model&, NodeHalo&);
template std::unique_ptr<Passes> make_passes_with<Sgmp, FlipPic>(Model&, NodeHalo&);
template std::unique_ptr<Passes> make_passes_with<Sgmp, Corrected>(Model&, NodeHalo&);

}  // namespace mpm::core
