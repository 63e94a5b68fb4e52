// Bodies that are in the same place at the start. Of different components contact would push them apart with
// forces that no load explains; others fill the place with the mass of both.
//
// A particle overlaps another body or component if a particle of that one is within half its own edge along
// every axis: cubes of that size share more than an eighth of their volume. Between bodies whose faces touch,
// particles are a whole edge apart.
#pragma once

#include <string>
#include <vector>

#include "core/communication/communication.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// A sentence for each pair of components that overlap, with the number of particles and where. Collective.
std::vector<std::string> overlaps_in_words(const Model& model, Communication& communication);

/// The same for each pair of bodies that contact does not part. Only particles of one brick are compared: an
/// overlap that is thinner than a particle's edge and lies between bricks is not seen. Collective.
std::vector<std::string> shared_places_in_words(const Model& model, Reductions& ranks);

}  // namespace mpm::core
