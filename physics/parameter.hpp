// A law's parameters as one table: the member that holds the value together with the name, range and meaning,
// used for input checking and the keyword reference.
#pragma once

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/scene/catalogue.hpp"
#include "core/scene/material.hpp"

namespace mpm::physics {

template <class Law>
struct Parameter {
  double Law::*member;
  core::ParameterInfo info;
};

/// Concatenates two tables, for laws that extend others' parameters.
template <class Law, std::size_t M, std::size_t N>
constexpr std::array<Parameter<Law>, M + N> join(const std::array<Parameter<Law>, M>& first,
                                                 const std::array<Parameter<Law>, N>& second) {
  std::array<Parameter<Law>, M + N> all{};
  for (std::size_t i = 0; i < M; ++i) all[i] = first[i];
  for (std::size_t i = 0; i < N; ++i) all[M + i] = second[i];
  return all;
}

/// Fills the members of `law`. A parameter without default that was not given keeps the member's own value.
template <class Law>
void read_parameters(Law& law, const core::LawInput& input) {
  for (const auto& [member, info] : Law::parameters()) {
    if (input.has(info.name)) {
      law.*member = input.at(info.name);
    } else if (info.required) {
      throw std::logic_error(input.type + " was created without its parameter " + std::string(info.name));
    } else if (!std::isnan(info.default_value)) {
      law.*member = info.default_value;
    }
  }
}

/// The same table without the members, for the catalogue.
template <class Law>
std::vector<core::ParameterInfo> parameter_infos() {
  std::vector<core::ParameterInfo> infos;
  for (const auto& parameter : Law::parameters()) infos.push_back(parameter.info);
  return infos;
}

}  // namespace mpm::physics
