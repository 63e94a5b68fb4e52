// Operations on lists of laws: iteration over the laws, and creation of a law from its input.
#pragma once

#include <string>
#include <string_view>
#include <type_traits>

#include "core/scene/errors.hpp"
#include "physics/parameter.hpp"

namespace mpm::physics {

template <class... Law>
struct LawList {};

/// f(std::type_identity<Law>()) for every law of a list.
template <class List, class F>
constexpr void for_each_law(F f) {
  [&]<class... Law>(std::type_identity<LawList<Law...>>) {
    (f(std::type_identity<Law>{}), ...);
  }(std::type_identity<List>{});
}

/// Checks the parameters against each other and computes the derived constants. `element` is for messages.
template <class Law>
void finish(Law& law, const core::LawInput& input, std::string_view element, double reference_density) {
  std::string fault;
  if constexpr (requires { law.fault(reference_density); }) {
    fault = law.fault(reference_density);
  } else if constexpr (requires { law.fault(); }) {
    fault = law.fault();
  }
  if (!fault.empty()) throw core::InputErrors(input.source, std::string(element), fault);
  if constexpr (requires { law.prepare(reference_density); }) {
    law.prepare(reference_density);
  } else if constexpr (requires { law.prepare(); }) {
    law.prepare();
  }
}

/// Creates the law with the input's values.
template <class Law>
Law read_law(const core::LawInput& input, std::string_view element, double reference_density) {
  Law law;
  read_parameters(law, input);
  finish(law, input, element, reference_density);
  return law;
}

}  // namespace mpm::physics
