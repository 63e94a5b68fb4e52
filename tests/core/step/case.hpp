#pragma once
// Small runs without input files: a case of the oracle (tests/support/reference_stepper.hpp) becomes a model
// of the production code, with the oracle's own stress update as its material, so that only the stepper is on
// trial.

#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <vector>

#include "core/communication/solo.hpp"
#include "core/particle_range.hpp"
#include "core/particles/tile_order.hpp"
#include "core/shape/list.hpp"
#include "core/step/passes.hpp"
#include "core/step/speeds.hpp"
#include "core/step/stepper.hpp"
#include "tests/support/effort.hpp"
#include "tests/support/reference_stepper.hpp"

namespace mpm::tests {

/// A stepper lets denormal numbers count as zero, for the thread that made it and for good: other tests do
/// not want that.
class KeepFloatingPoint {
 public:
  KeepFloatingPoint() { std::fegetenv(&before_); }
  ~KeepFloatingPoint() { std::fesetenv(&before_); }
  KeepFloatingPoint(const KeepFloatingPoint&) = delete;
  KeepFloatingPoint& operator=(const KeepFloatingPoint&) = delete;

 private:
  std::fenv_t before_;
};

/// Whether a particle fails at a time.
using FailsAt = std::function<bool(const ReferenceParticle&, double time)>;

/// The oracle's law, lane by lane. History 0 and 1 are its wave speed and its rate of volumetric strain.
/// Failed particles, if there are to be any, carry a mark, and stress as before.
class OracleLaw final : public core::ConstitutiveModel {
 public:
  /// `lightness`: times which its density of reference is less than the one that its stress depends on.
  explicit OracleLaw(const ReferenceMaterial& material, FailsAt fails = {}, double lightness = 1)
      : material_(material), fails_(std::move(fails)), lightness_(lightness) {}

  const std::string& name() const override { return name_; }
  double initial_sound_speed() const override {
    return std::sqrt(material_.young / (3 * (1 - 2 * material_.poisson) * material_.density));
  }
  double initial_shear_speed() const override {
    return std::sqrt(material_.young / (2 * (1 + material_.poisson)) / material_.density);
  }
  double reference_density() const override { return material_.density / lightness_; }
  core::ColumnSet columns(const core::UpdateOptions&) const override {
    core::ColumnSet set{core::Column::effective_plastic_strain, core::Column::history_0,
                        core::Column::history_1};
    if (fails_) set.add(core::Column::failed);
    return set;
  }

  void initialise(core::Batch& batch, const core::UpdateOptions&) const override {
    each(batch, [&](int, ReferenceParticle& p) { p.c = wave_speed(material_, p); });
  }
  void update(core::Batch& batch, const core::UpdateOptions&) const override {
    each(batch, [&](int i, ReferenceParticle& p) {
      Matrix l;
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b)
          l[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] = batch.gradient[3 * a + b][i];
      }
      update_stress(material_, batch.cell_size, batch.dt, l, p, batch.new_viscosity());
      if (!std::isfinite(p.E)) ++batch.events.not_finite;
      if (fails_ && fails_(p, batch.time))
        batch.column(core::Column::failed, i / core::block_lanes)[i % core::block_lanes] = 1;
    });
  }

  static ReferenceParticle read(const core::ColumnLayout& layout, const double* lane) {
    const auto at = [&](core::Column c) { return lane[layout.offset(c)]; };
    ReferenceParticle p;
    for (int a = 0; a < 3; ++a) {
      p.x[static_cast<std::size_t>(a)] = at(next(core::Column::position_x, a));
      p.v[static_cast<std::size_t>(a)] = at(next(core::Column::velocity_x, a));
    }
    p.m = at(core::Column::mass);
    p.V = at(core::Column::volume);
    const double xy = at(core::Column::s_xy), yz = at(core::Column::s_yz), xz = at(core::Column::s_xz);
    p.s = {{{at(core::Column::s_xx), xy, xz},
            {xy, at(core::Column::s_yy), yz},
            {xz, yz, at(core::Column::s_zz)}}};
    p.p = at(core::Column::pressure);
    p.q = at(core::Column::viscous_pressure);
    p.E = at(core::Column::internal_energy);
    p.epef = at(core::Column::effective_plastic_strain);
    p.c = at(core::Column::history_0);
    p.D = at(core::Column::history_1);
    return p;
  }
  static void write(const core::ColumnLayout& layout, const ReferenceParticle& p, double* lane) {
    const auto put = [&](core::Column c, double value) { lane[layout.offset(c)] = value; };
    for (int a = 0; a < 3; ++a) {
      put(next(core::Column::position_x, a), p.x[static_cast<std::size_t>(a)]);
      put(next(core::Column::velocity_x, a), p.v[static_cast<std::size_t>(a)]);
    }
    put(core::Column::mass, p.m);
    put(core::Column::volume, p.V);
    put(core::Column::s_xx, p.s[0][0]), put(core::Column::s_yy, p.s[1][1]),
        put(core::Column::s_zz, p.s[2][2]);
    put(core::Column::s_xy, p.s[0][1]), put(core::Column::s_yz, p.s[1][2]),
        put(core::Column::s_xz, p.s[0][2]);
    put(core::Column::pressure, p.p);
    put(core::Column::viscous_pressure, p.q);
    put(core::Column::internal_energy, p.E);
    put(core::Column::effective_plastic_strain, p.epef);
    put(core::Column::history_0, p.c);
    put(core::Column::history_1, p.D);
  }

 private:
  /// Lanes out of use get a speed that is no number: nobody may read it.
  template <class F>
  void each(core::Batch& batch, F f) const {
    for (int i = 0; i < core::block_lanes * batch.blocks; ++i) {
      batch.critical_speed[i] = std::numeric_limits<double>::quiet_NaN();
      if (i >= batch.particles) continue;
      double* lane = batch.block[i / core::block_lanes] + i % core::block_lanes;
      ReferenceParticle p = read(*batch.layout, lane);
      batch.old_volume[i] = p.V;
      f(i, p);
      write(*batch.layout, p, lane);
      const double q = p.D < 0 ? material_.bq2 * p.c - material_.bq1 * batch.cell_size * p.D : 0.0;
      batch.critical_speed[i] = q + std::sqrt(q * q + p.c * p.c);
    }
  }

  std::string name_ = "oracle";
  ReferenceMaterial material_;
  FailsAt fails_;
  double lightness_;
};

inline core::Scheme scheme_of(ReferenceScheme s) {
  return s == ReferenceScheme::usf     ? core::Scheme::usf
         : s == ReferenceScheme::usl   ? core::Scheme::usl
         : s == ReferenceScheme::usavg ? core::Scheme::usavg
                                       : core::Scheme::musl;
}

inline core::Transfer transfer_of(ReferenceTransfer t) {
  return t == ReferenceTransfer::xpic   ? core::Transfer::xpic
         : t == ReferenceTransfer::fmpm ? core::Transfer::fmpm
                                        : core::Transfer::flip;
}

inline core::ShapeFunction shape_function_of(ReferenceShape s) {
  switch (s) {
    case ReferenceShape::linear: return core::ShapeFunction::linear;
    case ReferenceShape::sgmp: return core::ShapeFunction::sgmp;
    case ReferenceShape::ddmp: return core::ShapeFunction::ddmp;
    case ReferenceShape::quadratic_bspline: return core::ShapeFunction::quadratic_bspline;
    case ReferenceShape::cubic_bspline: return core::ShapeFunction::cubic_bspline;
    case ReferenceShape::ugimp: return core::ShapeFunction::uniform_gimp;
    case ReferenceShape::cpgimp: return core::ShapeFunction::contiguous_particle_gimp;
    case ReferenceShape::cpdi: return core::ShapeFunction::cpdi;
    case ReferenceShape::cpdi2: return core::ShapeFunction::cpdi2;
  }
  throw std::logic_error("a shape that only the oracle has");
}

/// The oracle's shape of a policy. A policy without one does not compile: add it here.
constexpr ReferenceShape reference_shape(std::type_identity<core::Linear>) { return ReferenceShape::linear; }
constexpr ReferenceShape reference_shape(std::type_identity<core::Sgmp>) { return ReferenceShape::sgmp; }
constexpr ReferenceShape reference_shape(std::type_identity<core::Ddmp>) { return ReferenceShape::ddmp; }
constexpr ReferenceShape reference_shape(std::type_identity<core::UniformGimp>) {
  return ReferenceShape::ugimp;
}
constexpr ReferenceShape reference_shape(std::type_identity<core::ContiguousGimp>) {
  return ReferenceShape::cpgimp;
}
constexpr ReferenceShape reference_shape(std::type_identity<core::Cpdi>) { return ReferenceShape::cpdi; }
constexpr ReferenceShape reference_shape(std::type_identity<core::Cpdi2>) { return ReferenceShape::cpdi2; }
constexpr ReferenceShape reference_shape(std::type_identity<core::QuadraticBSpline>) {
  return ReferenceShape::quadratic_bspline;
}
constexpr ReferenceShape reference_shape(std::type_identity<core::CubicBSpline>) {
  return ReferenceShape::cubic_bspline;
}

/// The shapes of the program's list that this build has: a sanitizer build has one of each kind
/// (CMakePresets.json).
inline const std::vector<ReferenceShape> reference_shapes =
    []<class... S>(std::type_identity<std::tuple<S...>>) {
      std::vector<ReferenceShape> built;
      ((core::is_built<S> ? built.push_back(reference_shape(std::type_identity<S>())) : void()), ...);
      return built;
    }(std::type_identity<core::Shapes>());

/// Whether this build has the passes of the shape.
inline bool has_passes(ReferenceShape shape) {
  return std::ranges::find(reference_shapes, shape) != reference_shapes.end();
}

/// Whether a brief test of all shapes, each with one scheme in turn, leaves this pair out.
inline bool left_out(ReferenceShape shape, ReferenceScheme scheme) {
  return brief_tests && static_cast<int>(shape) % 3 != static_cast<int>(scheme) % 3;
}

/// A particle's first domain, for the shapes that have columns for it.
inline void write_box(const core::ColumnLayout& layout, const Vector& half_size, double* lane) {
  const auto put = [&](core::Column column, double value) {
    if (layout.has(column)) lane[layout.offset(column)] = value;
  };
  const DomainCorners corner = box(half_size);
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    put(next(core::Column::half_size_x, a), half_size[i]);
    for (int k = 0; k < 3; ++k) put(next(core::Column::edge_1x, 3 * k + a), k == a ? half_size[i] : 0);
    for (int n = 0; n < 8; ++n)
      put(next(core::Column::corner_0x, 3 * n + a), corner[static_cast<std::size_t>(n)][i]);
  }
}

/// One run of the production stepper. Bodies: particles [0, split) of the case are the first, the rest the
/// second; with `contact` each is a component, and so are the particles that `fails` marks.
struct SmallRun {
  KeepFloatingPoint keep;
  std::shared_ptr<core::Scene> scene = std::make_shared<core::Scene>();
  core::SoloCommunication solo;
  core::Model model;
  std::unique_ptr<core::Stepper> stepper;

  explicit SmallRun(const ReferenceCase& c, std::size_t split = std::numeric_limits<std::size_t>::max(),
                    bool contact = false, FailsAt fails = {}) {
    scene->contact.enable = contact;
    scene->contact.failed_to_component = contact && fails;
    scene->components.resize(2);
    scene->solution.scheme = scheme_of(c.scheme);
    scene->solution.automatic_scheme = false;
    scene->solution.transfer = transfer_of(c.transfer);
    if (c.consistent) scene->solution.mass = core::MassMatrix::consistent;
    scene->solution.xpic_order = c.order;
    scene->solution.xpic_interval = c.interval;
    if (c.average) scene->solution.averaging = core::VolumeAveraging::cell;
    scene->solution.pressure_relaxation = c.relaxation;
    scene->solution.end_time = 1e30;
    scene->solution.time_step.factor = c.dt_factor;
    scene->solution.gravity = {c.gravity[0], c.gravity[1], c.gravity[2]};
    scene->grid.shape = shape_function_of(c.shape);
    for (std::size_t i = 0; i < 3; ++i) {
      scene->grid.axes[i].lower = static_cast<core::Boundary>(c.boundary[2 * i]);
      scene->grid.axes[i].upper = static_cast<core::Boundary>(c.boundary[2 * i + 1]);
    }
    model.scene = scene;
    model.scheme = scene->solution.scheme;
    model.materials.push_back(std::make_unique<OracleLaw>(c.material, std::move(fails)));
    const bool has_light = c.light_from < c.particles.size();
    if (has_light) {
      if (split != c.light_from) throw std::logic_error("light particles that are not the second body's");
      model.materials.push_back(std::make_unique<OracleLaw>(c.material, FailsAt{}, 1000));
    }
    core::GridGeometry g;
    for (int a = 0; a < 3; ++a) {
      const auto i = static_cast<std::size_t>(a);
      g.origin[a] = c.origin[i];
      g.cell[a] = c.cell[i];
      g.inverse_cell[a] = 1 / c.cell[i];
      g.cells[i] = c.cells[i];
    }
    for (std::size_t f = 0; f < 6; ++f) g.boundary[f] = static_cast<core::Boundary>(c.boundary[f]);
    g.site = core::site_of(*scene);
    g.mass_cutoff = c.mass_cutoff * c.material.density * g.cell_volume();
    model.grid = std::make_unique<core::BrickGrid>(
        g, core::node_block_of(*scene), core::node_arrays_of(*scene, scene->solution.scheme, false));
    core::ColumnSet columns = core::ColumnSet::mechanics();
    columns.add(model.materials[0]->columns({}));
    columns.add(core::shape_columns(*scene));
    for (const core::Boundary b : g.boundary) {
      if (b == core::Boundary::nonreflecting) columns.add(core::Column::sound_speed);
    }
    for (int b = 0; b < (split < c.particles.size() ? 2 : 1); ++b) {
      core::Body& body = model.bodies.emplace_back();
      body.name = "body";
      body.component = b;
      body.material = c.weigh_cells || has_light ? b : 0;  // cells weigh where there are two
      body.model = model.materials[has_light ? static_cast<std::size_t>(b) : 0].get();
      body.pool = std::make_shared<core::BlockPool>(core::ColumnLayout(columns));
    }
    model.ledger.body_eroded.resize(model.bodies.size());
    model.ledger.body_left.resize(model.bodies.size());

    core::MigrationBuffer moving;
    std::vector<core::BrickCount> counts;
    const core::ColumnLayout& layout = model.bodies[0].pool->layout();
    std::vector<double> block(static_cast<std::size_t>(layout.block_doubles())),
        flat(static_cast<std::size_t>(layout.columns()));
    double fastest = 0;
    for (std::size_t n = 0; n < c.particles.size(); ++n) {
      ReferenceParticle p = c.particles[n];
      p.c = wave_speed(c.material, p);
      OracleLaw::write(layout, p, block.data());
      block[static_cast<std::size_t>(layout.offset(core::Column::identity))] = static_cast<double>(n);
      if (layout.has(core::Column::sound_speed))
        block[static_cast<std::size_t>(layout.offset(core::Column::sound_speed))] = p.c;
      write_box(layout, c.gimp_half_size, block.data());
      for (std::size_t k = 0; k < flat.size(); ++k) flat[k] = block[core::block_lanes * k];
      const core::BrickCoord to = g.brick_at({p.x[0], p.x[1], p.x[2]});
      moving.add(to, n < split ? 0 : 1, flat.data(), layout.columns());
      counts.push_back({to, 1});
      fastest = std::max(fastest, p.c / core::wave_limit(*model.scene, model.scheme) +
                                      std::sqrt(p.v[0] * p.v[0] + p.v[1] * p.v[1] + p.v[2] * p.v[2]));
    }
    solo.bricks.partition(*model.grid, counts, {});
    core::insert_particles(model, moving);
    core::sort_tiles(model);
    model.clock.critical_dt = model.clock.first_critical_dt = core::critical_step(*model.grid, fastest);
  }

  void step(int n = 1) {
    if (!stepper) stepper = std::make_unique<core::Stepper>(model, solo);
    for (int i = 0; i < n; ++i) stepper->step();
  }

  /// Particles by identity.
  std::map<std::int64_t, ReferenceParticle> particles() const {
    std::map<std::int64_t, ReferenceParticle> all;
    for (const core::ConstParticleBlock& block : core::blocks_of(model)) {
      for (int i = 0; i < block.used; ++i) {
        all[static_cast<std::int64_t>(block.particle(i)[core::Column::identity])] =
            OracleLaw::read(*block.layout, block.data + i);
      }
    }
    return all;
  }

  /// All columns of all particles by identity, for comparison to the last bit.
  std::map<std::int64_t, std::vector<double>> columns() const {
    std::map<std::int64_t, std::vector<double>> all;
    for (const core::ConstParticleBlock& block : core::blocks_of(model)) {
      for (const core::ConstParticle p : block) {
        auto& values = all[static_cast<std::int64_t>(p[core::Column::identity])];
        for (int c = 0; c < p.layout().columns(); ++c) values.push_back(p.nth(c));
      }
    }
    return all;
  }

  /// Identities in the order in which sums run: brick by brick in the order of keys, body by body.
  std::vector<std::int64_t> order() const {
    std::map<core::BrickKey, std::vector<std::int64_t>> bricks;
    for (const core::Brick& brick : model.grid->bricks()) {
      for (const core::ParticleTile& tile : brick.tiles) {
        const core::BlockPool& pool = *model.bodies[static_cast<std::size_t>(tile.body)].pool;
        const int at = pool.layout().offset(core::Column::identity);
        for (std::uint32_t i = 0; i < tile.count; ++i) {
          bricks[core::key_of(brick.coord)].push_back(static_cast<std::int64_t>(
              pool.block(tile.blocks[i / core::block_lanes])[at + static_cast<int>(i % core::block_lanes)]));
        }
      }
    }
    std::vector<std::int64_t> all;
    for (const auto& [key, identities] : bricks) all.insert(all.end(), identities.begin(), identities.end());
    return all;
  }
};

/// A block of elastic particles, 2 per cell edge, on a grid of oblong cells whose origin is negative and
/// whose last bricks are partial; it flies obliquely and turns, over several bricks.
inline ReferenceCase tumbling_block() {
  ReferenceCase c;
  c.material.density = 2;
  c.material.young = 900;
  c.material.poisson = 0.3;
  c.material.bq1 = 1.5;
  c.material.bq2 = 0.06;
  c.origin = {-3.1, -7.3, -5.2};
  c.cell = {1, 0.8, 1.25};
  c.cells = {14, 18, 11};
  c.gimp_half_size = {0.25, 0.2, 0.3125};
  const Vector dx{0.5, 0.4, 0.625}, centre{2.4, 0.35, 1.1};
  for (int k = 0; k < 8; ++k) {
    for (int j = 0; j < 9; ++j) {
      for (int i = 0; i < 10; ++i) {
        ReferenceParticle p;
        p.x = {centre[0] + dx[0] * (i - 4.5), centre[1] + dx[1] * (j - 4), centre[2] + dx[2] * (k - 3.5)};
        const double x = p.x[0] - centre[0], y = p.x[1] - centre[1], z = p.x[2] - centre[2];
        p.v = {6 - 0.9 * y, -5 + 0.9 * x - 0.4 * z, 4 + 0.4 * y};
        p.V = dx[0] * dx[1] * dx[2];
        p.m = c.material.density * p.V;
        c.particles.push_back(p);
      }
    }
  }
  return c;
}

/// The same material in free space of 24 x 12 x 12 unit cells, without particles.
inline ReferenceCase open_space(ReferenceShape shape, ReferenceScheme scheme) {
  ReferenceCase c = tumbling_block();
  c.shape = shape;
  c.scheme = scheme;
  c.material.bq1 = c.material.bq2 = 0;
  c.cell = {1, 1, 1};
  c.origin = {0, 0, 0};
  c.cells = {24, 12, 12};
  c.boundary.fill(0);
  c.gimp_half_size = {0.25, 0.25, 0.25};
  c.dt_factor = 0.4;
  c.particles.clear();
  return c;
}

}  // namespace mpm::tests
