// The largest stable time step of each method, in units of the time in which a wave crosses a cell.
#pragma once

#include "core/model.hpp"

namespace mpm::core {

/// Largest stable time step of a scheme with these shape functions, over the time in which a wave crosses the
/// smallest cell edge. Above 1, since a particle's functions average over more than a cell; below, where the
/// strains follow the velocities with more noise. benchmarks/stability/limits.py found by bisection the
/// largest steps without growth of the energy (elastic block and fluid that drift across cells, copper bar
/// and shock); these are 2 to 5 % below, and linear functions with MUSL keep the thesis' 1. Over 100,000
/// steps (long_runs.py: an elastic block with the default viscosity) USL and USF need shorter ones, as a
/// particle that has crept to the edge of a cell is unstable there; their limits are the largest that held.
/// With USAVG CPDI2 failed after 70,000 steps with 1.2, and not with 1. CPDI2 with FMPM and MUSL gains 19 %
/// there at 0.9, and nothing at 0.72. Bodies with one particle in a cell have shorter steps with FLIP and
/// functions whose gradients jump (wave_limit.cpp).
///
///                 MUSL            USAVG           USF             USL
///                 block fluid bar, each
///   linear        0.95 0.99 1.3   1.2  1.0  1.3   1.2  1.2  1.3   0.67 0.64 0.73
///   SGMP          1.5  1.3  2.2   1.9  1.5  2.2   1.5  1.3  2.3   1.0  0.80 1.2
///   DDMP          1.5  1.0  1.7   1.5  1.2  1.7   0.70 0.99 1.7   0.99 0.77 1.1
///   uGIMP         1.5  1.0  1.5   1.5  1.3  1.6   0.80 1.3  1.7   0.80 0.73 0.77
///   cpGIMP        1.5  1.0  1.5   1.5  1.3  1.6   0.77 1.3  1.7   0.80 0.77 0.77
///   CPDI, CPDI2   1.6  1.0  1.6   1.5  1.1  1.7   0.87 1.2  1.7   0.80 0.77 0.77
///   quadratic     1.6  1.2  1.8   1.7  1.3  1.8   1.0  1.2  1.9   1.0  0.73 1.1
///   cubic         1.5  1.3  2.0   1.8  1.5  2.1   1.7  1.3  2.2   1.3  1.0  1.4
/// Over 100,000 steps USF: cpGIMP 0.6 (not 0.68); linear has a remedy of its own (face_traps.hpp); USL:
/// linear 0.24 (not 0.3), uGIMP and cpGIMP 0.56 (not 0.63). USL with DDMP: 0.40 in cells of 1 x 1 x 0.1 (not
/// 0.43, where the energy doubles). PIC, XPIC and FMPM allow longer steps than FLIP (not PIC with GIMP and
/// USAVG: 1.18; not linear with FMPM: fluid 0.87, stable at factor 1 by the weight of tension, below; with
/// USAVG FMPM has MUSL's limits: 1.04 in the fluid with GIMP), affine transfers shorter ones, with USAVG as
/// with MUSL; fluid, the smaller of APIC and TPIC | AFLIP:
///   uGIMP, cpGIMP 0.73 | 0.67         0.64 | 0.67         0.23 | none, 0.23
///   quadratic     0.87 | 0.62         0.91 | 0.62         0.42 | none
///   cubic         1.1  | 0.77         1.1  | 0.77         0.44 | none
double wave_limit(ShapeFunction shape, Scheme scheme, Transfer transfer);
double wave_limit(const Scene& scene, Scheme scheme);
/// The same of the scheme in use.
double wave_limit(const Model& model);

/// Weight of a fluid's critical speed while it is in tension, which pulls particles together: functions with
/// kinks then gain energy below the limits above. Of a dam break (12,800 particles, a fluid that bears
/// tension) at a factor of 0.9 the energy grew by 24 % with linear functions and MUSL, 3.3 % with USF, 5.6 %
/// with uGIMP; with these weights it stays within 1 %.
double tension_weight(const Scene& scene, Scheme scheme);

}  // namespace mpm::core
