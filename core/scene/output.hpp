#pragma once
// The outputs of the run from the input.

#include <optional>
#include <string>
#include <vector>

#include "core/scene/errors.hpp"
#include "core/tensor/vec3.hpp"

namespace mpm::core {

struct ConsoleInput {
  double print_time = 0;  ///< interval; end time / 100 unless given
  bool print_momentum = false;
};

struct PostProcessingInput {
  enum class Vtk { none = 0, one_file = 1, file_per_body = 2 };
  enum class GridData { none = 0, positions = 1, mapped = 2 };

  double time_interval = 0;  ///< > 0
  bool h5part = false;
  Vtk vtk = Vtk::none;
  bool tecplot = false;
  bool cell_result = false;
  GridData grid_data = GridData::none;
  bool fragments = false;
  std::optional<double> fragments_time_interval;  ///< time_interval unless given
  std::vector<std::string> variables;  ///< names as in keywords.md, each once, in the input's order
};

/// Histories of variables at the particle nearest to a point, or at a point in space, and of the reactions of
/// bodies.
struct TimeHistoryInput {
  std::vector<std::string> variables;  ///< of particles
  std::vector<Vec3<double>> particles;
  std::vector<Vec3<double>> points;
  SourceLocation source;
  bool force = false, moment = false;  ///< of the bodies
  std::vector<std::string> bodies;     ///< names
};

/// A line along one axis; (first, second) are the coordinates on the other two axes in ascending order.
struct LineInput {
  int normal = 0;
  double first = 0;
  double second = 0;
};

struct StatisticsInput {
  bool memory = false;
  bool cell_occupancy = false;
};

struct OutputInput {
  ConsoleInput console;
  std::optional<PostProcessingInput> post_processing;
  std::vector<TimeHistoryInput> histories;
  std::optional<LineInput> grid_line;
  std::optional<LineInput> fem_profile;
  std::optional<double> restart_interval;  ///< time, > 0
  StatisticsInput statistics;
  bool summary = true;
};

}  // namespace mpm::core
