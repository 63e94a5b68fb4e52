#include "core/discretise/make_source.hpp"

#include <variant>

#include <fmt/format.h>

#include "core/discretise/block.hpp"
#include "core/discretise/difference.hpp"
#include "core/discretise/lattice.hpp"
#include "core/discretise/points.hpp"
#include "core/discretise/revolved.hpp"
#include "core/discretise/shells.hpp"

namespace mpm::core {

namespace {

using Source = std::unique_ptr<SeedSource>;

/// Creates a source for the geometry that a body holds.
struct Maker {
  const Scene& scene;
  const BodyInput& body;
  Frame frame;

  Source operator()(const PointGeometry& g) const {
    if (!g.file.empty()) return std::make_unique<FilePoints>(g.file, body.source, frame, body.density);
    return std::make_unique<InlinePoints>(g.points, frame, body.density);
  }
  Source operator()(const BlockGeometry& g) const {
    return std::make_unique<BlockSource>(g, frame, body.density);
  }
  Source operator()(const SphereGeometry& g) const {
    if (g.layout == Layout::polar) return std::make_unique<ShellSource>(g, frame, body.density);
    return std::make_unique<BallLattice>(g, frame, body.density);
  }
  Source operator()(const CylinderGeometry& g) const { return turned(revolved(g), g.layout); }
  Source operator()(const OgiveGeometry& g) const { return turned(revolved(g), g.layout); }
  Source operator()(const BoolGeometry& g) const {
    BodyInput minuend = body_at(scene, g.minuend);
    minuend.density = body.density;
    return std::make_unique<DifferenceSource>(make_unchecked_source(scene, minuend),
                                              make_inside_test(scene, body_at(scene, g.subtrahend)), frame);
  }
  template <class Mesh>
  Source operator()(const Mesh&) const {
    throw InputErrors(body.source, "Body",
                      fmt::format("type \"{}\" is known but not implemented yet: body `{}` cannot be made of "
                                  "particles",
                                  body.type, body.name));
  }

 private:
  Source turned(const Revolved& solid, Layout layout) const {
    if (layout == Layout::polar) return std::make_unique<RingSource>(solid, frame, body.density);
    return std::make_unique<RevolvedLattice>(solid, frame, body.density);
  }
};

}  // namespace

std::unique_ptr<SeedSource> make_unchecked_source(const Scene& scene, const BodyInput& body) {
  return std::visit(Maker{scene, body, Frame(scene, body)}, body.geometry);
}

bool is_surely_empty(const SeedSource& source) {
  constexpr std::uint64_t few = 64;
  if (source.units() > few) return false;
  std::vector<Seed> seeds;
  for (std::uint64_t u = 0; u < source.units() && seeds.empty(); ++u) source.generate(u, u + 1, seeds);
  return seeds.empty();
}

}  // namespace mpm::core
