// The keyword reference, in Markdown: every element and attribute from the Specification and the laws'
// tables.
#pragma once

#include <string>

#include "core/scene/catalogue.hpp"

namespace mpm::io {

std::string keyword_reference(const core::Catalogue& catalogue);

}  // namespace mpm::io
