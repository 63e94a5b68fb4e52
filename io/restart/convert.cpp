#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "io/output/h5part.hpp"
#include "io/restart/contents.hpp"
#include "io/restart/restart.hpp"

namespace mpm::io {

namespace {

/// Placeholder for a material of which only the name and the density are used.
class StoredMaterial final : public core::ConstitutiveModel {
 public:
  StoredMaterial(std::string name, double density) : name_(std::move(name)), density_(density) {}
  const std::string& name() const override { return name_; }
  core::ColumnSet columns(const core::UpdateOptions&) const override { return {}; }
  double initial_sound_speed() const override { return 0; }
  double reference_density() const override { return density_; }
  void initialise(core::Batch&, const core::UpdateOptions&) const override {}
  void update(core::Batch&, const core::UpdateOptions&) const override {}

 private:
  std::string name_;
  double density_;
};

template <class T>
T& at_grown(std::vector<T>& values, int i) {
  if (values.size() <= static_cast<std::size_t>(i)) values.resize(static_cast<std::size_t>(i) + 1);
  return values[static_cast<std::size_t>(i)];
}

/// A model with the bodies, grid and names of the file.
core::Model model_for(const RestartContents& contents) {
  core::Model model;
  auto scene = std::make_shared<core::Scene>();
  scene->header = contents.header;
  scene->provenance = contents.provenance;
  model.grid = std::make_unique<core::BrickGrid>(contents.grid);
  core::BlockPools pools;
  for (const BodyRecord& record : contents.bodies) {
    at_grown(scene->materials, record.material_number).name = record.material;
    core::ComponentInput& component = at_grown(scene->components, record.component_number);
    component.name = record.component;
    component.bodies.emplace_back().name = record.name;
    model.materials.push_back(std::make_unique<StoredMaterial>(record.material, record.reference_density));
    core::ColumnSet columns;
    for (const core::Column c : record.columns) columns.add(c);
    core::Body& body = model.bodies.emplace_back();
    body.name = record.name;
    body.component = record.component_number;
    body.material = record.material_number;
    body.model = model.materials.back().get();
    body.no_output = record.no_output;
    body.pool = pools.of(columns);
  }
  model.scene = std::move(scene);
  return model;
}

}  // namespace

void restart_to_h5part(const std::string& path, const std::string& h5part,
                       const std::vector<Variable>& variables, bool double_precision,
                       core::Communication& communication) {
  core::Reductions& ranks = communication.reductions;
  RestartContents contents;
  together(ranks, [&] {
    check_guard(path);
    contents = read_contents(path);
  });
  core::Model model = model_for(contents);
  read_restart(path, model, communication);
  H5PartWriter writer({h5part, variables, double_precision, std::nullopt}, model, ranks);
  writer.write(model, ranks);
  writer.finish(ranks);
  if (ranks.rank() == 0 && !writer.warning().empty()) fmt::print(stderr, "warning: {}\n", writer.warning());
}

}  // namespace mpm::io
