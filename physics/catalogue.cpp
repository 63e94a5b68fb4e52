#include "physics/catalogue.hpp"

#include <algorithm>
#include <utility>

#include "physics/eos/list.hpp"
#include "physics/failure/list.hpp"
#include "physics/laws.hpp"
#include "physics/material/common_parameters.hpp"
#include "physics/strength/list.hpp"

namespace mpm::physics {

namespace {

/// Laws that share a name, to be told apart by a parameter, are one type with the parameters of all.
void add(std::vector<core::TypeInfo>& infos, core::TypeInfo info) {
  const auto same = std::ranges::find(infos, info.name, &core::TypeInfo::name);
  if (same == infos.end()) {
    infos.push_back(std::move(info));
    return;
  }
  for (const core::ParameterInfo& parameter : info.parameters) {
    if (std::ranges::find(same->parameters, parameter.name, &core::ParameterInfo::name) ==
        same->parameters.end())
      same->parameters.push_back(parameter);
  }
}

template <class List>
std::vector<core::TypeInfo> types() {
  std::vector<core::TypeInfo> infos;
  for_each_law<List>([&]<class Law>(std::type_identity<Law>) {
    if constexpr (Named<Law>) add(infos, {Law::name, Law::summary, parameter_infos<Law>()});
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
