// Provenance: the same facts at the head of every output file of a run.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scene/scene.hpp"

namespace mpm::io {

/// Names and values in printing order; none is empty. Values are one line each, UTF-8.
using ProvenanceLines = std::vector<std::pair<std::string, std::string>>;

/// The git hash of the sources, with the suffix `-dirty` if they had uncommitted changes.
std::string git_text();

/// Program, version, git hash, build, job, input file and its hash, units, and the date of the call (UTC).
ProvenanceLines provenance_of(const core::Scene& scene);

/// One line per fact, each starting with `prefix`: "# " for text files.
std::string to_text(const ProvenanceLines& lines, const std::string& prefix);

/// An XML comment with the same lines.
std::string to_xml_comment(const ProvenanceLines& lines);

/// As text or as the value of an attribute; a control character becomes a space.
std::string xml_escaped(std::string_view text);

/// `name` with characters invalid in file names or column headings replaced by '_'; never empty.
std::string safe_name(const std::string& name);

}  // namespace mpm::io
