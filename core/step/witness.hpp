// The particle that a message names: of several, the one with the smallest identity, so that the message is
// the same on any ranks and threads.
#pragma once

#include <limits>
#include <string>

#include "core/step/exchange.hpp"

namespace mpm::core {

struct Witness {
  double identity = std::numeric_limits<double>::infinity();
  std::string words;

  bool empty() const { return words.empty(); }
  /// Keep the one with the smaller identity; `words` is called only if that is the new one.
  template <class F>
  void offer(double other, F other_words) {
    if (!empty() && identity <= other) return;
    identity = other;
    words = other_words();
  }
};

/// The first over all ranks. Collective.
inline Witness first_of_all(Exchange& exchange, const Witness& mine) {
  double identity[1] = {mine.identity};
  exchange.minimum(identity);
  Witness first;
  for (const std::string& words :
       exchange.gather(mine.identity == identity[0] ? mine.words : std::string())) {
    if (!words.empty()) first.offer(identity[0], [&] { return words; });
  }
  return first;
}

}  // namespace mpm::core
