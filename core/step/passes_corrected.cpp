// XPIC and FMPM in a unit of their own: more code beside the other transfers would change what the compiler
// inlines into them.
#include "core/shape/list.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/corrected.hpp"

namespace mpm::core {

template std::unique_ptr<Passes> make_passes_with<Linear, Corrected>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<Sgmp, Corrected>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<Ddmp, Corrected>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<UniformGimp, Corrected>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<ContiguousGimp, Corrected>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<Cpdi, Corrected>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<Cpdi2, Corrected>(Model&, NodeHalo&, RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<QuadraticBSpline, Corrected>(Model&, NodeHalo&,
                                                                               RigidBodies*);
template std::unique_ptr<Passes> make_passes_with<CubicBSpline, Corrected>(Model&, NodeHalo&, RigidBodies*);

}  // namespace mpm::core
