#pragma once
// Seeds: the particles of a body's shape, generated in pieces. A source divides its body into units of work,
// and any rank can generate any of them. No rank stores more than its own share; the seeds and their
// identities are bitwise identical for every distribution of the units. The lattices and their limits are
// described in block.hpp, lattice.hpp, revolved.hpp, shells.hpp and points.hpp. Tested by
// tests/core/discretise.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/scene/scene.hpp"

namespace mpm::core {

/// A particle before its creation.
struct Seed {
  Vec3<double> position{};  ///< length, global frame
  double mass = 0;
  double volume = 0;           ///< mass over the body's initial density
  std::uint64_t identity = 0;  ///< unique within the body, below SeedSource::identities()
};

/// Identities of all bodies together must stay below this: they are stored as doubles.
inline constexpr std::uint64_t identity_limit = std::uint64_t{1} << 53;

/// The particles of one body. All functions may be called from several threads at a time.
class SeedSource {
 public:
  SeedSource() = default;
  SeedSource(const SeedSource&) = delete;
  SeedSource& operator=(const SeedSource&) = delete;
  virtual ~SeedSource() = default;

  /// Pieces of work, each of at most some thousand seeds; many are empty. Their order follows the body in
  /// layers, so ranks that take every N-th run of units are better balanced than ranks that take one
  /// contiguous range each.
  virtual std::uint64_t units() const = 0;

  /// Size of the range of identities: the number of candidates, before any test. At least identity_limit when
  /// the body has too many to be numbered; generate() must not be called then.
  virtual std::uint64_t identities() const = 0;

  /// Estimate at the cost of some thousand operations, whatever the body's size. Exact for Point and Block
  /// bodies; for Bool bodies the number before the subtraction.
  virtual double expected_particles() const = 0;

  /// Appends the seeds of the units [first_unit, last_unit), in the order of their identities.
  virtual void generate(std::uint64_t first_unit, std::uint64_t last_unit, std::vector<Seed>& out) const = 0;

  /// Global box that contains every seed; it may be larger than needed by up to the size of the shape or of
  /// its rotated box.
  virtual std::array<Vec3<double>, 2> bounds() const = 0;

  /// Volume of the shape that the input states; NaN where it is not known without generating (Bool).
  virtual double solid_volume() const = 0;
};

/// The source for one body of the scene (for Bool bodies it looks up the operands there). Throws InputErrors
/// for a shape without particles, an impossible geometry (shape_check.hpp), a bad point file, and finite
/// element geometries. Every rank reads a point file once, to count and check it.
std::unique_ptr<SeedSource> make_seed_source(const Scene& scene, const BodyInput& body);

}  // namespace mpm::core
