// The material library (Materials.xml): values of the literature with their units and sources, and how a
// Material of an input names one.
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

/// Reads the notation of Materials.xml; throws std::logic_error on a mistake, for it is part of the program.
Library parse_library(std::string_view xml);

/// The built-in Materials.xml.
const Library& library();

/// Fills in what each Material with `library=` leaves out, converted to the units of the input. What cannot
/// be filled in is complained about, and marked incomplete.
void fill_in_from_library(Document& document, const Library& library, Diagnostics& diagnostics);

/// The units of an input: of its first Material with `units`, else of Header / Unit where that names units.
std::optional<core::UnitSystem> units_of(const Document& document);

/// Every entry with its laws, values and sources, for people to read.
std::string library_listing(const Library& library, const core::Catalogue& catalogue);

/// The entries that `name` may have meant, as "; did you mean 'a', 'b'?", or nothing.
std::string library_suggestions(const Library& library, std::string_view name);

}  // namespace mpm::io
