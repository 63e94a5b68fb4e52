#pragma once
// The shapes of bodies, each in the axes of its own work plane. Lengths in the user's unit, angles in
// degrees.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "core/tensor/vec3.hpp"

namespace mpm::core {

/// Arrangement of particles in a round shape.
enum class Layout { orthogonal = 0, polar = 1 };  // polar: spherical shells, or rings

struct PointMass {
  double mass = 0;  ///< > 0
  Vec3<double> position{};
};

/// Particles given individually: inline, or in a text file (lines: mass x y z; may be gzipped).
struct PointGeometry {
  std::vector<PointMass> points;
  std::string file;  ///< resolved against the input's folder; empty when the points are inline
};

struct BlockGeometry {
  double spacing = 0;     ///< distance of neighbouring particles, > 0
  Vec3<double> origin{};  ///< corner with the smallest coordinates
  Vec3<double> size{};    ///< > 0
};

struct SphereGeometry {
  double spacing = 0;
  Vec3<double> centre{};
  double outer_radius = 0;
  double inner_radius = 0;
  double angle = 360;       ///< sweep about local Z from the xz half plane, (0, 360]
  bool upper_half = false;  ///< keep only z >= centre (angle 90: the first octant)
  Layout layout = Layout::orthogonal;
};

/// Cylinder, cone or frustum along local Z; the spacing grades geometrically from bottom to top.
struct CylinderGeometry {
  Vec3<double> base_centre{};
  double bottom_spacing = 0;
  double top_spacing = 0;
  double bottom_inner_radius = 0;
  double bottom_outer_radius = 0;
  double top_inner_radius = 0;
  double top_outer_radius = 0;
  double height = 0;
  double angle = 360;
  Layout layout = Layout::orthogonal;
};

/// Ogive nose along local Z.
struct OgiveGeometry {
  Vec3<double> base_centre{};
  double bottom_spacing = 0;
  double top_spacing = 0;
  double ogive_radius = 0;
  double end_radius = 0;
  double angle = 360;
  Layout layout = Layout::orthogonal;
};

/// A body's position in the scene: components[component].bodies[body]. By default no body.
struct BodyPlace {
  std::size_t component = std::numeric_limits<std::size_t>::max();
  std::size_t body = 0;
};

/// A minus B.
struct BoolGeometry {
  BodyPlace minuend;
  BodyPlace subtrahend;
};

/// A mesh given node by node, inline or in a file; N nodes per element: 2 bar, 3 membrane triangle, 8
/// hexahedron.
template <std::size_t N>
struct MeshGeometry {
  struct Node {
    std::int64_t id = 0;  ///< from 1
    Vec3<double> position{};
  };
  struct Element {
    std::int64_t id = 0;  ///< from 1
    std::array<std::int64_t, N> nodes{};
    double sectional_area = 0;  ///< bars only
  };
  std::vector<Node> nodes;
  std::vector<Element> elements;
  std::int64_t file_nodes = 0;
  std::int64_t file_elements = 0;
  std::string file;
  double thickness = 0;  ///< membranes only
};
using BarMeshGeometry = MeshGeometry<2>;
using MembraneMeshGeometry = MeshGeometry<3>;
using HexahedronMeshGeometry = MeshGeometry<8>;

/// Parallel straight bars.
struct BarLinesGeometry {
  double sectional_area = 0;
  double element_size = 0;
  std::int64_t lines = 0;
  int extend_direction = 0;  ///< axis along which each bar runs
  int expand_direction = 0;  ///< axis along which the bars are repeated
  double length = 0;
  Vec3<double> origin{};
  double interval = 0;  ///< distance of neighbouring bars
};

/// A lattice of bars, copied in two directions.
struct BarNetGeometry {
  double sectional_area = 0;
  Vec3<double> origin{};
  Vec3<double> element_size{};          ///< z: 0 leaves the layers unconnected
  std::array<std::int64_t, 3> lines{};  ///< lines along x, lines along y, layers in z
  Vec3<double> interval{};
  int line_direction = 0;
  int column_direction = 1;
  std::int64_t column_copies = 0;
  double column_interval = 0;
  std::int64_t line_copies = 0;
  double line_interval = 0;
};

/// A flat membrane in the local xy plane.
struct MembraneRectangleGeometry {
  double thickness = 0;
  double element_size = 0;
  Vec3<double> origin{};
  std::array<double, 2> size{};
};

/// A cylinder wall along local Z.
struct MembraneCylinderGeometry {
  double thickness = 0;
  double element_size = 0;
  Vec3<double> base_centre{};
  double radius = 0;
  double height = 0;
  double angle = 360;
};

/// A block of hexahedral finite elements; its spacing is the element size.
struct HexahedronBlockGeometry : BlockGeometry {};

using Geometry = std::variant<PointGeometry, BlockGeometry, SphereGeometry, CylinderGeometry, OgiveGeometry,
                              BoolGeometry, BarMeshGeometry, BarLinesGeometry, BarNetGeometry,
                              MembraneMeshGeometry, MembraneRectangleGeometry, MembraneCylinderGeometry,
                              HexahedronMeshGeometry, HexahedronBlockGeometry>;

}  // namespace mpm::core
