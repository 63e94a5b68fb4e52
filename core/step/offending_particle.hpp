// The particle that a message names: the candidate with the smallest identity, so that the message does not
// depend on ranks and threads.
#pragma once

#include <cstdlib>
#include <iterator>
#include <limits>
#include <map>
#include <string>

#include <fmt/format.h>

#include "core/communication/reductions.hpp"

namespace mpm::core {

struct OffendingParticle {
  double identity = std::numeric_limits<double>::infinity();
  std::string words;

  bool empty() const { return words.empty(); }
  /// Keeps the candidate with the smaller identity; `words` is called only if that is the new one.
  template <class F>
  void offer(double other, F other_words) {
    if (!empty() && identity <= other) return;
    identity = other;
    words = other_words();
  }
};

/// The first few, in ascending order of identity.
class OffendingParticles {
 public:
  static constexpr std::size_t most = 20;

  bool empty() const { return words_.empty(); }
  const std::map<double, std::string>& words() const { return words_; }
  /// As OffendingParticle::offer.
  template <class F>
  void offer(double identity, F words) {
    if (words_.size() == most && identity >= words_.rbegin()->first) return;
    const auto [at, is_new] = words_.try_emplace(identity);
    if (is_new) at->second = words();
    if (words_.size() > most) words_.erase(std::prev(words_.end()));
  }
  void merge(const OffendingParticles& other) {
    for (const auto& [identity, words] : other.words_) offer(identity, [&words = words] { return words; });
  }

 private:
  std::map<double, std::string> words_;
};

/// The first few over all ranks. Collective.
inline OffendingParticles first_of_all(Reductions& ranks, const OffendingParticles& mine) {
  std::string lines;
  for (const auto& [identity, words] : mine.words()) lines += fmt::format("{:.17g} {}\n", identity, words);
  OffendingParticles all;
  for (const std::string& of_rank : ranks.gather(lines)) {
    for (std::size_t at = 0; at < of_rank.size();) {
      const std::size_t space = of_rank.find(' ', at), end = of_rank.find('\n', at);
      all.offer(std::strtod(of_rank.c_str() + at, nullptr),
                [&] { return of_rank.substr(space + 1, end - space - 1); });
      at = end + 1;
    }
  }
  return all;
}

/// The first over all ranks. Collective.
inline OffendingParticle first_of_all(Reductions& ranks, const OffendingParticle& mine) {
  double identity[1] = {mine.identity};
  ranks.minimum(identity);
  OffendingParticle first;
  for (const std::string& words : ranks.gather(mine.identity == identity[0] ? mine.words : std::string())) {
    if (!words.empty()) first.offer(identity[0], [&] { return words; });
  }
  return first;
}

}  // namespace mpm::core
