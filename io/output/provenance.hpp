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

/// With it, the longest name of a file has less than a file system's 255 bytes.
inline constexpr std::size_t most_bytes_of_job = 200;

/// `name` with characters invalid in file names or column headings replaced by '_'; never empty.
std::string safe_name(const std::string& name);

/// The safe names of the bodies or materials, `kind`, of a model: where two are equal, or one is longer than
/// `most` bytes (at least 20), with the kind and the number: a_b_body0, a_b_body1.
std::vector<std::string> distinct_names(const std::vector<std::string>& names, const std::string& kind,
                                        std::size_t most = std::string::npos);

}  // namespace mpm::io
