// The larger parts of a scene as text; see echo.hpp.
#pragma once

#include "core/scene/scene.hpp"
#include "io/input/xml_writer.hpp"

namespace mpm::io {

void echo_component(XmlWriter& writer, const core::ComponentInput& component, const core::Scene& scene);
void echo_grid(XmlWriter& writer, const core::GridInput& grid);
void echo_solution(XmlWriter& writer, const core::SolutionInput& solution);
void echo_output(XmlWriter& writer, const core::OutputInput& output);
void echo_fixed_layer(XmlWriter& writer, std::string_view name, const core::FixedLayer& layer);

}  // namespace mpm::io
