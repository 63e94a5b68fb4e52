// Bodies of different components that are in the same place at the start: contact would push them apart with
// forces that no load explains.
//
// A particle overlaps another component if a particle of that one is within half its own edge along every
// axis: cubes of that size share more than an eighth of their volume. Between bodies whose faces touch,
// particles are a whole edge apart.
#pragma once

#include <string>
#include <vector>

#include "core/communication/communication.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// A sentence for each pair of components that overlap, with the number of particles and where. Collective.
std::vector<std::string> overlaps_in_words(const Model& model, Communication& communication);

}  // namespace mpm::core
