#include "io/input/library.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "io/embedded/materials.hpp"
#include "io/input/text.hpp"

namespace mpm::io {

namespace {

[[noreturn]] void mistake(std::string_view where, std::string_view what) {
  throw std::logic_error(fmt::format("Materials.xml: {}: {}", where, what));
}

std::string_view value_of(const Document& document, const XmlElement& element, std::string_view name) {
  for (const XmlAttribute& a : document.attributes(element))
    if (a.name == name) return a.value;
  return {};
}

template <class F>
void for_each_child(const Document& document, std::uint32_t parent, const F& f) {
  for (std::uint32_t i = document.elements()[parent].first_child; i != 0;
       i = document.elements()[i].next_sibling)
    f(i);
}

bool has(const LibraryEntry& entry, std::string_view element, std::string_view attribute) {
  return std::ranges::any_of(
      entry.values, [&](const LibraryValue& v) { return v.element == element && v.attribute == attribute; });
}

/// Completes the first entry from the second, except for a law of another type.
void supplement(LibraryEntry& entry, const LibraryEntry& other) {
  const auto same_law = [](std::string& mine, const std::string& theirs) {
    if (mine.empty()) mine = theirs;
    return theirs.empty() || mine == theirs;
  };
  const bool strength = same_law(entry.strength, other.strength), eos = same_law(entry.eos, other.eos);
  for (const LibraryValue& v : other.values) {
    if ((v.element == "StrengthModel" && !strength) || (v.element == "EquationOfState" && !eos)) continue;
    if (!has(entry, v.element, v.attribute)) entry.values.push_back(v);
  }
}

void parse_values(LibraryEntry& entry, const Document& document, const XmlElement& element,
                  const Library& library) {
  const std::string source(value_of(document, element, "source"));
  if (std::ranges::find(library.sources, source, &LibrarySource::id) == library.sources.end())
    mistake(entry.name, fmt::format("there is no source '{}'", source));
  for (const XmlAttribute& a : document.attributes(element)) {
    if (a.name == "source" || a.name == "note") continue;
    if (a.name == "type") {
      (element.name == "StrengthModel" ? entry.strength : entry.eos) = a.value;
      continue;
    }
    if (has(entry, element.name, a.name)) mistake(entry.name, fmt::format("{} occurs twice", a.name));
    entry.values.push_back({std::string(element.name), std::string(a.name), std::string(a.value), source,
                            std::string(value_of(document, element, "note"))});
  }
}

LibraryEntry parse_entry(const Document& document, std::uint32_t index, const Library& library) {
  const XmlElement& element = document.elements()[index];
  LibraryEntry entry;
  entry.name = value_of(document, element, "name");
  entry.title = value_of(document, element, "title");
  entry.note = value_of(document, element, "note");
  if (library.find(entry.name)) mistake(entry.name, "occurs twice");
  for_each_child(document, index, [&](std::uint32_t child) {
    parse_values(entry, document, document.elements()[child], library);
  });
  if (const std::string_view base = value_of(document, element, "base"); !base.empty()) {
    const LibraryEntry* found = library.find(base);
    if (!found) mistake(entry.name, fmt::format("its base '{}' is not defined before it", base));
    LibraryEntry own = std::move(entry);
    entry = *found;
    entry.name = own.name;
    entry.title = own.title;
    if (!own.note.empty()) entry.note = own.note;
    std::erase_if(entry.values, [&](const LibraryValue& v) { return has(own, v.element, v.attribute); });
    entry.values.insert(entry.values.end(), own.values.begin(), own.values.end());
  }
  return entry;
}

/// The units of Header/Unit, if all three are recognised; else `why` says what is not.
std::optional<core::UnitSystem> header_units(const Document& document, std::string* why = nullptr) {
  std::optional<core::UnitSystem> units;
  for_each_child(document, 0, [&](std::uint32_t header) {
    if (document.elements()[header].name != "Header") return;
    for_each_child(document, header, [&](std::uint32_t i) {
      const XmlElement& unit = document.elements()[i];
      if (unit.name != "Unit") return;
      const std::string all = fmt::format("{} {} {}", value_of(document, unit, "length"),
                                          value_of(document, unit, "mass"), value_of(document, unit, "time"));
      try {
        units = core::UnitSystem::parse(all);
      } catch (const core::UnitError& error) {  // free text is allowed there
        if (why != nullptr) *why = error.what();
      }
    });
  });
  return units;
}

class Filler {
 public:
  Filler(Document& document, const Library& library, Diagnostics& diagnostics)
      : document_(document),
        library_(library),
        diagnostics_(diagnostics),
        header_units_(header_units(document, &unknown_units_)) {}

  void fill(std::uint32_t material) {
    const auto given = attribute(material, "library");
    const auto units_given = attribute(material, "units");
    if (!given) {
      if (units_given) report(*units_given, "is used only with library, to convert its values");
      return;
    }
    const std::optional<LibraryEntry> entry = find(*given);
    const std::optional<core::UnitSystem> units = units_of(material, units_given);
    if (!entry || !units) {
      document_.mark_incomplete(material);
      for_each_child(document_, material, [&](std::uint32_t child) { document_.mark_incomplete(child); });
      return;
    }
    merge(material, *entry, *units, given->line);
  }

 private:
  void report(const XmlAttribute& a, std::string message) {
    diagnostics_.add(a.line, "Material", a.name, a.value, std::move(message));
  }

  std::optional<XmlAttribute> attribute(std::uint32_t element, std::string_view name) const {
    for (const XmlAttribute& a : document_.attributes(document_.elements()[element]))
      if (a.name == name) return a;
    return {};
  }

  std::optional<LibraryEntry> find(const XmlAttribute& given) {
    std::optional<LibraryEntry> all;
    bool found_all = true;
    for (const std::string_view name : split(given.value, '|')) {
      const LibraryEntry* entry = library_.find(name);
      if (!entry) {
        report(given, fmt::format("the library has no '{}'{}; mpm_check --materials lists its contents", name,
                                  library_suggestions(library_, name)));
        found_all = false;
      } else if (!all) {
        all = *entry;
      } else {
        supplement(*all, *entry);
      }
    }
    if (!all && found_all) {
      report(given, "expected the name of a library material; mpm_check --materials lists them");
      return {};
    }
    return found_all ? all : std::nullopt;
  }

  std::optional<core::UnitSystem> units_of(std::uint32_t material, const std::optional<XmlAttribute>& given) {
    std::optional<core::UnitSystem> units;
    if (!given) {
      if (!header_units_)
        diagnostics_.add(
            document_.elements()[material].line, "Material",
            fmt::format(
                "attribute 'units' is missing: library values are converted to the units of this input, "
                "as in units=\"mm g ms\" (or give length, mass and time in Header / Unit{})",
                unknown_units_.empty() ? "" : "; of those given there " + unknown_units_));
      units = header_units_;
    } else {
      try {
        units = core::UnitSystem::parse(given->value);
      } catch (const core::UnitError& error) {
        report(*given, error.what());
        return {};
      }
      if (header_units_ && *header_units_ != *units) {
        report(*given, fmt::format("contradicts Header / Unit, {}; all units of an input must agree",
                                   header_units_->name()));
        return {};
      }
    }
    if (units && first_units_ && *first_units_ != *units) {
      if (given)
        report(*given, fmt::format("contradicts an earlier material, {}; all units of an input must agree",
                                   first_units_->name()));
      return {};
    }
    if (units) first_units_ = units;
    return units;
  }

  void merge(std::uint32_t material, const LibraryEntry& entry, const core::UnitSystem& units, int line) {
    const auto child = [&](std::string_view name) {
      std::optional<std::uint32_t> found;
      for_each_child(document_, material, [&](std::uint32_t i) {
        if (!found && document_.elements()[i].name == name) found = i;
      });
      return found ? *found : document_.add_child(material, name, line);
    };
    for (const auto& [name, type] : std::array<std::pair<std::string_view, std::string_view>, 3>{
             {{"ReferenceDensity", {}}, {"StrengthModel", entry.strength}, {"EquationOfState", entry.eos}}}) {
      if (type.empty() && std::ranges::find(entry.values, name, &LibraryValue::element) == entry.values.end())
        continue;
      const std::uint32_t element = child(name);
      const std::optional<XmlAttribute> other = attribute(element, "type");
      if (other && !type.empty() && other->value != type)
        continue;  // another law: the library's values do not apply
      if (!other && !type.empty()) document_.set_attribute(element, "type", type, line);
      for (const LibraryValue& v : entry.values) {
        if (v.element != name || attribute(element, v.attribute)) continue;
        const double value = units.value_of(core::parse_quantity(v.text));
        document_.set_attribute(element, v.attribute, fmt::format("{}", value), line);
      }
    }
  }

  Document& document_;
  const Library& library_;
  Diagnostics& diagnostics_;
  std::string unknown_units_;  ///< why those of Header / Unit are not known
  std::optional<core::UnitSystem> header_units_;
  std::optional<core::UnitSystem> first_units_;
};

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

bool knows(const std::vector<core::TypeInfo>& types, std::string_view name) {
  return std::ranges::find(types, name, &core::TypeInfo::name) != types.end();
}

}  // namespace

const LibraryEntry* Library::find(std::string_view name) const {
  const auto found = std::ranges::find(entries, name, &LibraryEntry::name);
  return found == entries.end() ? nullptr : &*found;
}

Library parse_library(std::string_view xml) {
  std::optional<XmlError> error;
  const Document document = parse_document(xml, error);
  if (error) mistake(fmt::format("line {}", error->line), error->message);
  Library result;
  for_each_child(document, 0, [&](std::uint32_t i) {
    const XmlElement& element = document.elements()[i];
    if (element.name == "Source")
      result.sources.push_back(
          {std::string(value_of(document, element, "id")), std::string(value_of(document, element, "text"))});
    else
      result.entries.push_back(parse_entry(document, i, result));
  });
  return result;
}

const Library& library() {
  static const Library all = parse_library(embedded::materials);
  return all;
}

void fill_in_from_library(Document& document, const Library& library, Diagnostics& diagnostics) {
  Filler filler(document, library, diagnostics);
  std::vector<std::uint32_t> materials;
  for_each_child(document, 0, [&](std::uint32_t i) {
    if (document.elements()[i].name == "Material") materials.push_back(i);
  });
  for (const std::uint32_t material : materials) filler.fill(material);
}

std::optional<core::UnitSystem> units_of(const Document& document) {
  std::optional<core::UnitSystem> units;
  for_each_child(document, 0, [&](std::uint32_t i) {
    const std::string_view text = value_of(document, document.elements()[i], "units");
    if (units || document.elements()[i].name != "Material" || text.empty()) return;
    try {
      units = core::UnitSystem::parse(text);
    } catch (const core::UnitError&) {}  // reported when values are filled in
  });
  return units ? units : header_units(document);
}

std::string library_suggestions(const Library& library, std::string_view name) {
  std::vector<std::string_view> names;
  std::vector<std::string> meant;
  for (const LibraryEntry& entry : library.entries) names.push_back(entry.name);
  const auto add = [&](std::string_view candidate) {
    if (meant.size() < 4 && std::ranges::find(meant, candidate) == meant.end()) meant.emplace_back(candidate);
  };
  if (const std::string_view best = nearest(name, names); !best.empty()) add(best);
  // Otherwise those whose name or title contains the word, or the longest part of it that any contains:
  // "copper", "Al-7075".
  const std::string wanted = lower(name);
  for (std::size_t length = wanted.size(); length >= 2 && meant.size() < 2; --length) {
    if (wanted[length - 1] == '-') continue;
    for (const LibraryEntry& entry : library.entries) {
      const std::string_view part = std::string_view(wanted).substr(0, length);
      if (lower(entry.name).find(part) != std::string::npos ||
          lower(entry.title).find(part) != std::string::npos)
        add(entry.name);
    }
  }
  if (meant.empty()) return {};
  return fmt::format("; did you mean '{}'?", join(meant, "', '"));
}

std::string library_listing(const Library& library, const core::Catalogue& catalogue) {
  std::string text;
  for (const LibraryEntry& entry : library.entries) {
    std::string laws;
    const auto add = [&](std::string_view name, const std::vector<core::TypeInfo>& types) {
      if (name.empty()) return;
      laws.append(laws.empty() ? ": " : ", ").append(name);
      if (!knows(types, name)) laws.append(" (not a law of this program)");
    };
    add(entry.strength, catalogue.strength);
    add(entry.eos, catalogue.eos);
    if (entry.strength.empty()) laws += fmt::format(" (a supplement: library=\"...|{}\")", entry.name);
    text += fmt::format("{}{}\n  {}\n", entry.name, laws, entry.title);
    if (!entry.note.empty()) text += fmt::format("  note: {}\n", entry.note);
    // One line per element and source, in the order of the file.
    for (std::size_t i = 0; i < entry.values.size();) {
      const LibraryValue& first = entry.values[i];
      std::vector<std::string> values;
      for (; i < entry.values.size() && entry.values[i].element == first.element &&
             entry.values[i].source == first.source && entry.values[i].note == first.note;
           ++i)
        values.push_back(first.element == "ReferenceDensity"
                             ? entry.values[i].text
                             : fmt::format("{} {}", entry.values[i].attribute, entry.values[i].text));
      text += fmt::format("  {}: {}  [{}]\n", first.element, join(values, ", "), first.source);
      if (!first.note.empty()) text += fmt::format("    note: {}\n", first.note);
    }
    text += '\n';
  }
  text += "Sources\n";
  for (const LibrarySource& source : library.sources)
    text += fmt::format("  [{}] {}\n", source.id, source.text);
  return text;
}

}  // namespace mpm::io
