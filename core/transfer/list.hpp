// The velocity transfers, each with its policy, and the shape functions that go with it.
#pragma once

#include <stdexcept>
#include <type_traits>

#include "core/shape/list.hpp"
#include "core/transfer/affine.hpp"
#include "core/transfer/consistent.hpp"
#include "core/transfer/corrected.hpp"

namespace mpm::core {

/// Whether particles may carry an affine velocity: the moments of the shape functions about a particle must
/// not vanish. Those of linear functions do at the nodes; the staggered grid lost most of the energy of a
/// Taylor bar with them.
template <class S>
inline constexpr bool affine_with = requires {
  &S::velocity_and_moments;
};

/// Whether the consistent mass matrix goes with these shape functions: with it, domains whose corners move
/// apart from the particles tangle at the surface of a fluid.
template <class S>
inline constexpr bool consistent_mass_with = !std::is_same_v<S, Cpdi> && !std::is_same_v<S, Cpdi2>;

/// f(std::type_identity<T>()) with the policy of the scene's transfer for the shape functions S.
template <class S, class F>
auto with_transfer(const SolutionInput& solution, F f) {
  const auto affine = [&]<class T>(std::type_identity<T> of) -> decltype(f(std::type_identity<Flip>())) {
    if constexpr (affine_with<S>) return f(of);
    throw std::logic_error("an affine transfer with shape functions that it does not go with");
  };
  const auto correction = [&]<class T>(std::type_identity<T> of) -> decltype(f(std::type_identity<Flip>())) {
    constexpr bool goes = !std::is_same_v<T, Consistent> || consistent_mass_with<S>;
    if constexpr (built_corrections && goes) return f(of);
    throw std::logic_error("a transfer that this build, or the shape functions, do not have");
  };
  switch (solution.transfer) {
    case Transfer::flip:
      if (solution.mass == MassMatrix::consistent) return correction(std::type_identity<Consistent>());
      if (solution.flip_fraction == 1) return f(std::type_identity<Flip>());
      return f(std::type_identity<FlipPic>());
    case Transfer::pic: return f(std::type_identity<FlipPic>());
    case Transfer::apic: return affine(std::type_identity<Apic>());
    case Transfer::tpic: return affine(std::type_identity<Tpic>());
    case Transfer::aflip: return affine(std::type_identity<Aflip>());
    case Transfer::xpic:
    case Transfer::fmpm: return correction(std::type_identity<Corrected>());
  }
  throw std::logic_error("a transfer without a policy");
}

}  // namespace mpm::core
