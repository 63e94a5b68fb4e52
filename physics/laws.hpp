// What the lists of laws are asked: a law by its word in the input, and every law in turn.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "core/scene/errors.hpp"
#include "physics/parameter.hpp"

namespace mpm::physics {

/// A law that the input can name; the others are built in.
template <class Law>
concept Named = requires {
  Law::name;
};

/// f(std::type_identity<Law>) for every law of a list.
template <class List, class F>
constexpr void for_each_law(F f) {
  [&]<class... Law>(std::type_identity<std::variant<Law...>>) {
    (f(std::type_identity<Law>{}), ...);
  }(std::type_identity<List>{});
}

/// The parameters checked against each other and the derived constants filled in. `element` is for messages.
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

/// The law of the list that the input names, ready for use.
template <class List>
List make_law(const core::LawInput& input, std::string_view element, double reference_density) {
  std::optional<List> made;
  for_each_law<List>([&]<class Law>(std::type_identity<Law>) {
    if constexpr (Named<Law>) {
      if (input.type != Law::name) return;
      if constexpr (requires { Law::chosen_by(input); }) {
        if (!Law::chosen_by(input)) return;
      }
      Law law;
      read_parameters(law, input);
      finish(law, input, element, reference_density);
      made = law;
    }
  });
  if (!made) throw core::InputErrors(input.source, std::string(element), input.type + " is not implemented");
  return *made;
}

}  // namespace mpm::physics
