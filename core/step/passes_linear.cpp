#include "core/shape/linear.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/flip.hpp"

namespace mpm::core {

template std::unique_ptr<Passes> make_passes_with<Linear, Flip>(Model&, NodeHalo&);
template std::unique_ptr<Passes> make_passes_with<Linear, FlipPic>(Model&, NodeHalo&);

}  // namespace mpm::core
