// A user's Specification.xml, in the notation of the manual's chapter 5.1. An input is checked against
// it and against the program's own; names that only the user's Specification has are accepted and reported,
// so that a keyword of another program requires only one line there.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/input/node.hpp"
#include "io/input/specification.hpp"

namespace mpm::io {

struct UserSpecification {
  std::string file;
  ElementSpec root;
};

/// Elements with `laws` get those of the catalogue. Throws core::InputErrors with every mistake in the file,
/// by its line.
UserSpecification read_user_specification(const std::filesystem::path& file,
                                          const core::Catalogue& catalogue);

/// The program's language and what the user's Specification has beyond it: elements, attributes, and words
/// among an attribute's values.
ElementSpec with_additions(ElementSpec ours, const ElementSpec& theirs);

/// Names in an input that only these additions define, one entry each.
std::vector<core::Diagnostic> foreign_names(const Node& root, const std::string& file);

}  // namespace mpm::io
