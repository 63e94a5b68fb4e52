// Checks a document against the language: names, occurrences, values, types, and what is not implemented yet.
#pragma once

#include "io/input/diagnostics.hpp"
#include "io/input/document.hpp"
#include "io/input/specification.hpp"

namespace mpm::io {

/// Adds a fault for everything that `language` does not allow. `accept_later` accepts input that is known but
/// not implemented yet.
void check(const Document& document, const ElementSpec& language, bool accept_later,
           Diagnostics& diagnostics);

}  // namespace mpm::io
