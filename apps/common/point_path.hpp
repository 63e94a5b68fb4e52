// The path language of mpm_point: legs separated by semicolons, each a kind, its numbers and options, as in
//   "hydrostatic pressure 10; triaxial -0.05 confining 10 rate 1e-3"
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "physics/point/path.hpp"

namespace mpm::apps {

/// A path that cannot be parsed; what() names the leg, the expectation and the nearest valid word.
class PathError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

struct PathDefaults {
  double rate = 1;
  int steps = 1000;
  int repeat = 1;  ///< number of times the whole path is run
};

std::vector<physics::Leg> parse_path(std::string_view text, const PathDefaults& defaults);

/// F(t) from a text file: time and nine components, row by row, per line, separated by commas or blanks;
/// lines that do not begin with a number are headings.
std::vector<physics::DeformationRow> read_deformation(const std::string& file);

/// Description of the path language for --help.
std::string path_help();

}  // namespace mpm::apps
