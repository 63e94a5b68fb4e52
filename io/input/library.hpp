// The material library (Materials.xml): literature values with units and sources, and references to them from
// a Material of an input.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/catalogue.hpp"
#include "core/units/units.hpp"
#include "io/input/diagnostics.hpp"
#include "io/input/document.hpp"

namespace mpm::io {

struct LibraryValue {
  std::string element;    ///< StrengthModel, EquationOfState, ReferenceDensity
  std::string attribute;  ///< never `type`
  std::string text;       ///< with the unit of its source: "90 MPa"
  std::string source;     ///< id of a LibrarySource
  std::string note;
};

struct LibraryEntry {
  std::string name;
  std::string title;
  std::string note;
  std::string strength;  ///< type; empty: a supplement to another entry
  std::string eos;       ///< type; empty: none
  std::vector<LibraryValue> values;
};

struct LibrarySource {
  std::string id, text;
};

struct Library {
  std::vector<LibrarySource> sources;
  std::vector<LibraryEntry> entries;

  const LibraryEntry* find(std::string_view name) const;
};

/// Reads the notation of Materials.xml; throws std::logic_error on a mistake, since the file is part of the
/// program.
Library parse_library(std::string_view xml);

/// The built-in Materials.xml.
const Library& library();

/// Completes each Material with `library=` by values converted to the units of the input. Faults are
/// reported, and the element is marked incomplete.
void fill_in_from_library(Document& document, const Library& library, Diagnostics& diagnostics);

/// The units of an input: of its first Material with `units`, else of Header / Unit where that names units.
std::optional<core::UnitSystem> units_of(const Document& document);

/// Every entry with its laws, values and sources as readable text.
std::string library_listing(const Library& library, const core::Catalogue& catalogue);

/// The entries that were probably meant by `name`, as "; did you mean 'a', 'b'?", or nothing.
std::string library_suggestions(const Library& library, std::string_view name);

}  // namespace mpm::io
