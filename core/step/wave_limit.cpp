#include "core/step/wave_limit.hpp"

namespace mpm::core {

namespace {

/// With the consistent mass matrix, which does not smooth the nodes' forces. The least of the measured, block
/// and fluid: linear 0.3 (not 0.45), DDMP 0.37, GIMP 0.52, quadratic 0.57, cubic 0.65, SGMP 0.77.
double consistent_wave_limit(ShapeFunction shape) {
  switch (shape) {
    case ShapeFunction::sgmp:
    case ShapeFunction::cubic_bspline: return 0.6;
    case ShapeFunction::quadratic_bspline: return 0.55;
    case ShapeFunction::uniform_gimp:
    case ShapeFunction::contiguous_particle_gimp: return 0.5;
    case ShapeFunction::ddmp: return 0.35;
    default: return 0.28;
  }
}

/// With FLIP and one particle in a cell, whose crossings of faces add energy at any step. A block that drifts
/// while it vibrates, at six places in the grid, gains at most, in per cent, at a factor of 0.9 of these
/// limits | of those of many particles:
///            MUSL        USAVG       USF
///   linear   4.6 | 88    0.6 | 3.2   4.4 | 5.4
///   DDMP     3.2 | 4.6   0.7 | 1.6
double single_particle_limit(ShapeFunction shape, Scheme scheme) {
  const bool linear = shape == ShapeFunction::linear;
  switch (scheme) {
    case Scheme::musl: return linear ? 0.5 : 0.8;
    case Scheme::usavg: return linear ? 0.7 : 0.8;
    case Scheme::usf: return linear ? 0.4 : 0.62;
    default: return linear ? 0.24 : 0.42;
  }
}

}  // namespace

double wave_limit(ShapeFunction shape, Scheme scheme, Transfer transfer) {
  const auto by_scheme = [scheme](double musl, double usf, double usl) {
    return scheme == Scheme::usf ? usf : scheme == Scheme::usl ? usl : musl;
  };
  if (scheme == Scheme::usavg && !is_affine(transfer) && transfer != Transfer::fmpm) {
    switch (shape) {
      case ShapeFunction::sgmp:
      case ShapeFunction::cubic_bspline: return 1.3;
      case ShapeFunction::quadratic_bspline: return 1.25;
      case ShapeFunction::ddmp: return 1.05;
      case ShapeFunction::linear: return 1;
      case ShapeFunction::cpdi:
      case ShapeFunction::cpdi2: return 1;
      default: return 1.2;
    }
  }
  if (is_affine(transfer)) {
    const bool aflip = transfer == Transfer::aflip;
    switch (shape) {
      case ShapeFunction::quadratic_bspline:
        return aflip ? by_scheme(0.57, 0.57, 0.15) : by_scheme(0.85, 0.85, 0.4);
      case ShapeFunction::cubic_bspline:
        return aflip ? by_scheme(0.75, 0.75, 0.15) : by_scheme(1.1, 1.1, 0.42);
      default: return aflip ? by_scheme(0.62, 0.62, 0.15) : by_scheme(0.7, 0.62, 0.22);
    }
  }
  switch (shape) {
    case ShapeFunction::sgmp: return by_scheme(1.25, 1.1, 0.75);
    case ShapeFunction::ddmp: return by_scheme(1, 0.62, 0.42);
    case ShapeFunction::uniform_gimp: return by_scheme(1, 0.75, 0.55);
    case ShapeFunction::contiguous_particle_gimp: return by_scheme(1, 0.6, 0.55);
    case ShapeFunction::cpdi: return by_scheme(1, 0.75, 0.7);
    case ShapeFunction::cpdi2: return by_scheme(transfer == Transfer::fmpm ? 0.8 : 1, 0.75, 0.7);
    case ShapeFunction::quadratic_bspline: return by_scheme(1.2, 0.95, 0.7);
    case ShapeFunction::cubic_bspline: return by_scheme(1.25, 1.1, 0.95);
    default: return by_scheme(1, 0.5, 0.24);
  }
}

double wave_limit(const Scene& scene, Scheme scheme) {
  if (scene.solution.mass == MassMatrix::consistent) return consistent_wave_limit(scene.grid.shape);
  if (scene.has_single_particles && scene.solution.transfer == Transfer::flip)
    return single_particle_limit(scene.grid.shape, scheme);
  return wave_limit(scene.grid.shape, scheme, scene.solution.transfer);
}

double wave_limit(const Model& model) { return wave_limit(*model.scene, model.scheme); }

double tension_weight(const Scene& scene, Scheme scheme) {
  const bool implicit = scene.solution.integration == Integration::implicit;
  if (implicit || scheme == Scheme::usl) return 1;
  if (scene.grid.shape == ShapeFunction::linear) return scheme == Scheme::musl ? 3 : 2.6;
  return scene.grid.shape == ShapeFunction::uniform_gimp ? 1.6 : 1;
}

}  // namespace mpm::core
