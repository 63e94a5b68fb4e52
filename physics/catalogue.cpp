#include "physics/catalogue.hpp"

#include "physics/eos/list.hpp"
#include "physics/failure/list.hpp"
#include "physics/laws.hpp"
#include "physics/material/common_parameters.hpp"
#include "physics/strength/list.hpp"

namespace mpm::physics {

namespace {

template <class List>
std::vector<core::TypeInfo> types() {
  std::vector<core::TypeInfo> infos;
  for_each_law<List>([&]<class Law>(std::type_identity<Law>) {
    if constexpr (Named<Law>) infos.push_back({Law::name, Law::summary, parameter_infos<Law>()});
  });
  return infos;
}

}  // namespace

core::Catalogue catalogue() {
  core::Catalogue all;
  all.common_strength = parameter_infos<CommonParameters>();
  all.common_eos = parameter_infos<CommonEosParameters>();
  all.strength = types<StrengthModel>();
  all.eos = types<EquationOfState>();
  all.failure = types<FailureModel>();
  all.failure.push_back({"none", "never fails", {}});
  return all;
}

}  // namespace mpm::physics
