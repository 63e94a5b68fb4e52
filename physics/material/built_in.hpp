// Converts a list of laws to registry entries.
#pragma once

#include <type_traits>
#include <vector>

#include "physics/registry.hpp"

namespace mpm::physics {

namespace detail {
template <class List>
struct InterfaceOf;
template <class First, class... Law>
struct InterfaceOf<LawList<First, Law...>> {
  using type = typename FamilyOf<First>::Interface;
};
}  // namespace detail

template <class List>
auto entries_of() {
  std::vector<LawEntry<typename detail::InterfaceOf<List>::type>> entries;
  for_each_law<List>([&]<class Law>(std::type_identity<Law>) { entries.push_back(entry_of<Law>()); });
  return entries;
}

}  // namespace mpm::physics
