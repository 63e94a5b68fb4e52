// Whether the bodies of a restart file fit those of a scene, and which column goes where.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/model.hpp"
#include "io/restart/contents.hpp"

namespace mpm::io {

struct Fit {
  struct Body {
    std::size_t number = 0;  ///< in the model
    std::vector<int>
        source;  ///< for each column of the model's layout: its place in the file's rows, or -1 for 0
    std::size_t file_columns = 0;
  };
  std::vector<std::optional<Body>> bodies;  ///< of the file; nullopt for those that no longer take part
  std::vector<std::size_t> new_bodies;      ///< of the model; missing in the file

  const Body* of(const TileRecord& record) const {
    const auto& body = bodies[static_cast<std::size_t>(record.body)];
    return body ? &*body : nullptr;
  }
};

/// Throws InputErrors with all incompatible differences; adds the acceptable ones to `notices`.
Fit fit_to_model(const RestartContents& contents, const core::Model& model,
                 std::vector<std::string>& notices);

}  // namespace mpm::io
