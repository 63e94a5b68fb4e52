#pragma once
// From the shape of a body to its particles, in pieces: a source knows its body's units of work, and any rank
// generates any of them. No rank ever needs more than its own share; the seeds and their identities are the
// same bits for every way of sharing the units out. The lattices and their limits are described in block.hpp,
// lattice.hpp, revolved.hpp, shells.hpp and points.hpp. Shown by tests/core/discretise.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/scene/scene.hpp"

namespace mpm::core {

/// A particle to be.
struct Seed {
  Vec3<double> position{};  ///< length, global frame
  double mass = 0;
  double volume = 0;           ///< mass over the body's initial density
  std::uint64_t identity = 0;  ///< unique within the body, below SeedSource::identities()
};

/// Identities of all bodies together must stay below this: they travel through doubles.
inline constexpr std::uint64_t identity_limit = std::uint64_t{1} << 53;

/// The particles of one body. All functions may be called from several threads at a time.
class SeedSource {
 public:
  SeedSource() = default;
  SeedSource(const SeedSource&) = delete;
  SeedSource& operator=(const SeedSource&) = delete;
  virtual ~SeedSource() = default;

  /// Pieces of work, each of at most some thousand seeds and many of none. They follow each other through the
  /// body in layers, so ranks that take every N-th run of units share better than ranks that take one stretch
  /// each.
  virtual std::uint64_t units() const = 0;

  /// Size of the range that the identities come from: the candidates, counted before any test. At least
  /// identity_limit when the body has too many of them to be numbered; generate() must not be called then.
  virtual std::uint64_t identities() const = 0;

  /// Estimate at the cost of some thousand operations, whatever the body's size. Exact for Point and Block
  /// bodies; for Bool the number before the subtraction.
  virtual double expected_particles() const = 0;

  /// Appends the seeds of the units [first_unit, last_unit), in the order of their identities.
  virtual void generate(std::uint64_t first_unit, std::uint64_t last_unit, std::vector<Seed>& out) const = 0;

  /// Global box that holds every seed; up to the shape's own size, or that of its turned box, larger than
  /// needed.
  virtual std::array<Vec3<double>, 2> bounds() const = 0;

  /// Volume of the shape that the input states; NaN where it is not known without generating (Bool).
  virtual double solid_volume() const = 0;
};

/// The source for one body of the scene (for Bool bodies it looks up the operands there). Throws InputErrors
/// for a shape without particles, an impossible geometry (shape_check.hpp), a bad point file, and geometries
/// made of finite elements. Reads a point file once, to count and check it; every rank does so.
std::unique_ptr<SeedSource> make_seed_source(const Scene& scene, const BodyInput& body);

}  // namespace mpm::core
