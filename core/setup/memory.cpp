#include "core/setup/memory.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

#include <sys/resource.h>
#include <unistd.h>

#include "core/step/conduction.hpp"
#include "core/step/node_update.hpp"
#include "core/step/passes.hpp"
#include "core/step/scheme_change.hpp"

namespace mpm::core {

namespace {

/// Measured: the input, its part of the model, its columns in a row of the .sta file, its part of the
/// summary.
constexpr double bytes_per_body = 5000;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The number after `word` in a file of names and numbers; without a word, the file's first number.
std::optional<double> number_in(const std::string& path, const std::string& word = {}) {
  std::ifstream file(path);
  for (std::string name; !word.empty() && name != word;) {
    if (!(file >> name)) return {};
  }
  double number = 0;
  if (file >> number) return number;
  return {};
}

/// Memory that the control group and its parents leave free. Their usage includes the page cache, which the
/// system releases on demand.
double left_in_group(const std::string& root, std::string group, const char* limit, const char* used,
                     const char* cached) {
  double left = infinity;
  for (;;) {
    const std::string folder = root + group + "/";
    const auto most = number_in(folder + limit), now = number_in(folder + used);
    if (most && now)
      left = std::min(left, *most - *now + number_in(folder + "memory.stat", cached).value_or(0));
    const std::size_t slash = group.rfind('/');
    if (slash == std::string::npos) return left;
    group.erase(slash);
  }
}

double left_in_groups() {
  double left = infinity;
  std::ifstream file("/proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {  // number:controllers:/path
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string kind = line.substr(first + 1, second - first - 1);
    std::string group = line.substr(second + 1);
    if (group == "/") group.clear();
    if (kind.empty())
      left = std::min(
          left, left_in_group("/sys/fs/cgroup", group, "memory.max", "memory.current", "inactive_file"));
    else if (kind == "memory")
      left = std::min(left, left_in_group("/sys/fs/cgroup/memory", group, "memory.limit_in_bytes",
                                          "memory.usage_in_bytes", "total_inactive_file"));
  }
  return left;
}

/// Pools larger than one huge page are allocated in whole huge pages.
double in_pages(double bytes) {
  constexpr double page = 1 << 21;
  return std::ceil(bytes / page) * page;
}

/// Of the node arrays of one brick, also of those that a change of the scheme adds.
double array_doubles(const Model& model) {
  NodeArraySet arrays = model.grid->arrays();
  if (may_change_scheme(*model.scene))
    arrays = node_arrays_of(*model.scene, Scheme::usavg, conducts_heat(model));
  double width = 0;
  for (const NodeArray of : node_arrays) width += arrays.has(of) ? record_doubles(of) : 0;
  return width * model.grid->shape().nodes();
}

}  // namespace

MemoryNeed memory_need(const Model& model) {
  MemoryNeed need;
  for (const BlockPool* pool : pools_of(model)) {
    const double bytes = sizeof(double) * static_cast<double>(pool->layout().block_doubles()) *
                         static_cast<double>(pool->blocks_in_use());
    need.particles += in_pages(bytes);
  }
  const BrickGrid& grid = *model.grid;
  constexpr double place = sizeof(Brick) + 64;  // and its entry in the table of coordinates
  const double arrays = array_doubles(model);
  const int kept = maps_back(model.scheme) ? motion_width : 0;  // doubles of a node between passes
  const double motion = kept * grid.shape().nodes() + product_doubles_of(*model.scene);
  need.bricks = (place + sizeof(double) * (arrays + motion)) * grid.owned() +
                (place + sizeof(double) * arrays) * grid.ghosts();
  for (const Brick& b : grid.bricks()) {
    for (const ParticleTile& c : b.tiles)
      need.bricks += sizeof(ParticleTile) + 16 + sizeof(BlockIndex) * static_cast<double>(c.blocks.size());
  }
  need.bodies = bytes_per_body * static_cast<double>(model.bodies.size());
  return need;
}

double available_memory() {
  const double of_system = number_in("/proc/meminfo", "MemAvailable:").value_or(0) * 1024;
  const double free = of_system > 0 ? of_system
                                    : static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                                          static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::max(std::min(free, left_in_groups()), 0.0);
}

double address_space_left() {
  struct rlimit limit {};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return infinity;
  const double pages = number_in("/proc/self/statm").value_or(0);
  return std::max(static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(sysconf(_SC_PAGESIZE)),
                  0.0);
}

}  // namespace mpm::core
