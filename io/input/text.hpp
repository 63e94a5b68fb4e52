// Small tools on the text of the input: numbers independent of the locale, lists, and the nearest valid word.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mpm::io {

std::string_view trim(std::string_view text);

/// The parts between `separator`, trimmed; an empty text has none.
std::vector<std::string_view> split(std::string_view text, char separator);

/// At most `bytes` of a UTF-8 text in complete characters; ... marks the omission.
std::string shortened(std::string_view text, std::size_t bytes);

std::string join(const std::vector<std::string>& words, std::string_view separator);

/// A finite real in C notation with full double precision: `.5`, `1.`, `+2e-3`. Nothing for `1d3`, `nan`,
/// `inf`, `0x1p3`, trailing text, a value beyond the range of double, or one that is not 0 and too small to
/// be kept with full precision (below 2.3e-308: the programs count such numbers as 0).
std::optional<double> parse_real(std::string_view text);

/// Whether the text is a real in C notation, of any size.
bool is_written_real(std::string_view text);

/// A whole number in decimal digits with an optional sign.
std::optional<std::int64_t> parse_integer(std::string_view text);

/// The candidate probably meant by `word`: equal up to case, else the nearest by edit distance if that is
/// small for its length. Empty if none is near.
std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates);

/// `; did you mean 'x'?`, or nothing.
std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& candidates);

/// 16 hexadecimal digits: FNV-1a, 64 bit, the public function, so that other programs can compute it for an
/// input file. Internal checks use the faster hash of io/output/hash.hpp.
std::string fnv1a_hex(std::string_view bytes);

}  // namespace mpm::io
