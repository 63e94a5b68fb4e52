// Ends a run whose state is not finite, before any of that state is written.
#pragma once

#include <span>
#include <string>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"
#include "core/step/offending_particle.hpp"

namespace mpm::core {

/// This rank's particle with the smallest identity whose state or energy is not finite; empty if none. The
/// text lists its columns. `body`, if not null, receives the number of its body.
OffendingParticle first_not_finite(const Model& model, int* body = nullptr);

/// Text that describes the fastest particle of all ranks and its speed; empty without particles. Collective.
std::string fastest_in_words(const Model& model, Reductions& ranks);
/// The same of the particle with the highest specific internal energy.
std::string hottest_in_words(const Model& model, Reductions& ranks);

/// `totals`: sums over all particles, the same on all ranks. Throws NumericalFailure on every rank if one of
/// them is not finite. Collective.
void require_finite(const Model& model, std::span<const double> totals, Reductions& ranks);
/// The same for the energies of the current state. Collective.
void require_finite(const Model& model, Reductions& ranks);

}  // namespace mpm::core
