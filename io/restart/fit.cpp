#include "io/restart/fit.hpp"

#include <algorithm>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

namespace mpm::io {

namespace {

class Fitting {
 public:
  Fitting(const RestartContents& contents, const core::Model& model, std::vector<std::string>& notices)
      : contents_(contents), model_(model), notices_(notices) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) numbers_.emplace(model.bodies[b].name, b);
    for (const core::ComponentInput& component : model.scene->components)
      for (const core::BodyInput& body : component.bodies) inputs_.emplace(body.name, &body);
  }

  Fit run() {
    Fit fit;
    std::vector<bool> filled(model_.bodies.size());
    for (const BodyRecord& record : contents_.bodies) {
      fit.bodies.push_back(place(record));
      if (fit.bodies.back()) filled[fit.bodies.back()->number] = true;
    }
    for (std::size_t b = 0; b < filled.size(); ++b) {
      if (!filled[b]) fit.new_bodies.push_back(b);
    }
    wrong_.raise_if_any();
    return fit;
  }

 private:
  void report(const core::SourceLocation& where, const std::string& name, std::string message) {
    wrong_.add({where.file, where.line, "Body", "name", name, std::move(message)});
  }

  std::optional<Fit::Body> place(const BodyRecord& record) {
    const auto found = numbers_.find(record.name);
    const auto stated = inputs_.find(record.name);
    const core::BodyInput* input = stated == inputs_.end() ? nullptr : stated->second;
    if (found == numbers_.end()) {
      leave_out(record, input);
      return std::nullopt;
    }
    const core::SourceLocation where = input != nullptr ? input->source : core::SourceLocation{};
    const core::Body& body = model_.bodies[found->second];
    check_material(record, body, where);
    return Fit::Body{found->second, sources(record, body, where), record.columns.size()};
  }

  void leave_out(const BodyRecord& record, const core::BodyInput* input) {
    if (input != nullptr && input->deactivated) {
      notices_.push_back(
          fmt::format("body '{}' is deactivated: its {} particles are removed, with their mass and energy "
                      "recorded as removed",
                      record.name, record.particles));
    } else if (record.particles > 0 && input != nullptr && input->for_bool) {
      report(input->source, record.name,
             "the restart file has particles of this body, but the scene makes it an operand of Bool bodies; "
             "remove ForBoolBody, or add Deactive=\"1\" to remove its particles");
    } else if (record.particles > 0) {
      report({model_.scene->provenance.path, 0}, record.name,
             "the restart file has this body, but the scene does not; add it, with Deactive=\"1\" to remove "
             "its particles");
    }
  }

  void check_material(const BodyRecord& record, const core::Body& body, const core::SourceLocation& where) {
    const std::string& material = model_.scene->materials[static_cast<std::size_t>(body.material)].name;
    if (material != record.material) {
      report(where, record.name,
             fmt::format("its material is '{}', but '{}' in the restart file; a body must keep its material",
                         material, record.material));
    } else if (body.model->reference_density() != record.reference_density) {
      report(
          where, record.name,
          fmt::format("its material '{}' has the reference density {:.17g}, but {:.17g} in the restart file",
                      material, body.model->reference_density(), record.reference_density));
    }
  }

  std::vector<int> sources(const BodyRecord& record, const core::Body& body,
                           const core::SourceLocation& where) {
    // State that a law reads back cannot start at zero; output-only columns can, and a lag, as in a first
    // step.
    core::UpdateOptions options = model_.options;
    options.keep_strain = false;
    core::ColumnSet needed = core::ColumnSet::mechanics();
    needed.add(body.model->columns(options));
    core::ColumnSet from_zero = shown_only();
    from_zero.add_range(core::Column::acceleration_lag_x, 3);

    std::vector<int> source;
    std::string missing, started, dropped;
    const auto list = [](std::string& names, core::Column c) {
      names.append(names.empty() ? "" : ", ").append(core::name_of(c));
    };
    for (int i = 0; i < core::column_count; ++i) {
      const auto c = static_cast<core::Column>(i);
      const auto at = std::find(record.columns.begin(), record.columns.end(), c);
      const bool there = at != record.columns.end();
      if (!body.pool->layout().has(c)) {
        if (there) list(dropped, c);
        continue;
      }
      source.push_back(there ? static_cast<int>(at - record.columns.begin()) : -1);
      if (!there) list(from_zero.has(c) && !needed.has(c) ? started : missing, c);
    }
    if (!missing.empty()) {
      report(where, record.name,
             fmt::format(
                 "the scene needs state that the restart file does not have: {}; keep the material laws, the "
                 "shape functions, the expressions in X, Y, Z and the volume update of the run that wrote it",
                 missing));
    }
    if (!started.empty()) {
      notices_.push_back(fmt::format("body '{}': {} start at zero, since the restart file does not have them",
                                     record.name, started));
    }
    if (!dropped.empty()) {
      notices_.push_back(
          fmt::format("body '{}': {} of the restart file are no longer needed", record.name, dropped));
    }
    return source;
  }

  const RestartContents& contents_;
  const core::Model& model_;
  std::vector<std::string>& notices_;
  core::ErrorList wrong_;
  std::unordered_map<std::string_view, std::size_t> numbers_;  ///< of the model's bodies, by name
  /// The scene's input of each body, whether it takes part or not.
  std::unordered_map<std::string_view, const core::BodyInput*> inputs_;
};

}  // namespace

Fit fit_to_model(const RestartContents& contents, const core::Model& model,
                 std::vector<std::string>& notices) {
  return Fitting(contents, model, notices).run();
}

}  // namespace mpm::io
