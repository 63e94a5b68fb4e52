// Averages over the particles of one body in the same site c (a cell, or with shape functions of three nodes
// per axis the surroundings of a node), against volumetric locking (Solution/Volumetric averaging="cell"):
//   strain  L_p <- L_p + (theta_c - tr L_p)/3 I,   theta_c = sum V_p tr L_p / sum V_p
//   force   p_p <- p_c = sum V_p (p + q)_p / sum V_p
// Nearly incompressible material then has one constraint per site instead of one per particle. This is the
// B-bar method with a constant volume change (T. J. R. Hughes, IJNME 15 (1980) 1413) in rate form, with means
// over particles in the place of an element's integrals. Other ways to bring B-bar and F-bar to the material
// point method: R. M. Telikicherla and G. Moutsanidis, arXiv:2407.03826, and the literature there. The mean
// pressure belongs to it: sum V p_c tr L = sum V p theta_c, so that forces do the work that the particles
// store. With the mean volume change alone a dam break doubles its energy.
//
// Equal volume changes leave the pressures of a site's particles as different as they were, and forces do not
// see the differences: particles that come from different sites, and tension that has been cut off, make more
// of them all the time. Where sound equalises pressure inside a cell, so does the relaxation (an extension),
//   tr L_p <- tr L_p + r (c0/h) (p_p - p_c)/K,   K = rho0 c0^2 + 8 |p_c|,   r c0/h at most 1/dt:
// p_p approaches p_c, sum V_p tr L_p stays as it is, and with it the site's volume. 8 is above dK/dp of
// solids, liquids and gases, so that the difference does not change its sign. The forces of the step do not
// change. The particles lose r sum V (p_p - p_c)^2/K of their energy in the time h/c0: that of the
// differences, twice.
//
// A site belongs to one brick, and sums follow the order of its particles: the same bits on any ranks and
// threads. Tested by tests/core/step/site_averages_test.cpp and against the naive stepper.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/material/batch.hpp"
#include "core/shape/shape.hpp"

namespace mpm::core {

/// Numbers of the sites of a block's particles, below the number of nodes of its brick.
template <class Place>
const int* sites_of(const Place& place) {
  if constexpr (requires { place.lowest; })
    return place.lowest;
  else
    return place.node;
}

class SiteAverages {
 public:
  void resize(int sites) { of_site_.resize(static_cast<std::size_t>(sites)); }
  void clear() { std::fill(of_site_.begin(), of_site_.end(), OfSite{}); }

  /// Volume changes of the first `used` particles of a block; their gradients are in rows at .. at + 7.
  void add_volume_changes(const int* sites, const double* volume, const Row (&gradient)[9], int at,
                          int used) {
    for (int l = 0; l < used; ++l) add(sites[l], volume[l], trace(gradient, at + l));
  }
  /// Gives a block's gradients the mean volume changes.
  void average_gradients(const int* sites, Row (&gradient)[9], int at) const {
    for (int l = 0; l < block_lanes; ++l) {
      const double own = trace(gradient, at + l);
      const double more = (mean(sites[l], own) - own) / 3;
      for (int i = 0; i < 9; i += 4) gradient[i][at + l] += more;
    }
  }

  /// Pressures at the start of the step, without viscosity, for relax_pressures().
  void add_old_pressures(const int* sites, const ColumnLayout& layout, const double* block, int used) {
    const double* volume = block + layout.offset(Column::volume);
    const double* pressure = block + layout.offset(Column::pressure);
    for (int l = 0; l < used; ++l)
      of_site_[static_cast<std::size_t>(sites[l])].old_pressure += volume[l] * pressure[l];
  }
  /// Adds to a block's gradients the volume changes that let its pressures approach those of the sites.
  /// `rate`: r c0/h; `modulus`: rho0 c0^2.
  void relax_pressures(const int* sites, const ColumnLayout& layout, const double* block, double rate,
                       double modulus, Row (&gradient)[9], int at) const {
    const double* pressure = block + layout.offset(Column::pressure);
    for (int l = 0; l < block_lanes; ++l) {
      const OfSite& of = of_site_[static_cast<std::size_t>(sites[l])];
      if (of.volume <= 0) continue;
      const double mean = of.old_pressure / of.volume;
      const double more = rate * (pressure[l] - mean) / (3 * (modulus + 8 * std::abs(mean)));
      for (int i = 0; i < 9; i += 4) gradient[i][at + l] += more;
    }
  }

  /// Pressures of the first `used` particles of a block.
  void add_pressures(const int* sites, const ColumnLayout& layout, const double* block, int used) {
    const double* volume = block + layout.offset(Column::volume);
    for (int l = 0; l < used; ++l) add(sites[l], volume[l], pressure(layout, block, l));
  }
  /// Gives V sigma of a block the mean pressures.
  [[gnu::noinline]] void average_pressures(const int* sites, const ColumnLayout& layout, const double* block,
                                           MappedRows& rows) const {
    const double* volume = block + layout.offset(Column::volume);
    for (int l = 0; l < block_lanes; ++l) {
      const double own = pressure(layout, block, l);
      const double less = volume[l] * (mean(sites[l], own) - own);
      for (int a = 0; a < 3; ++a) rows.stress[a][l] -= less;
    }
  }

 private:
  struct OfSite {
    double volume = 0, sum = 0, old_pressure = 0;
  };
  void add(int site, double volume, double value) {
    OfSite& to = of_site_[static_cast<std::size_t>(site)];
    to.volume += volume;
    to.sum += volume * value;
  }
  /// Lanes out of use may be in a site without particles.
  double mean(int site, double own) const {
    const OfSite& of = of_site_[static_cast<std::size_t>(site)];
    return of.volume > 0 ? of.sum / of.volume : own;
  }
  static double trace(const Row (&gradient)[9], int row) {
    return gradient[0][row] + gradient[4][row] + gradient[8][row];
  }
  static double pressure(const ColumnLayout& layout, const double* block, int lane) {
    return block[layout.offset(Column::pressure) + lane] +
           block[layout.offset(Column::viscous_pressure) + lane];
  }
  std::vector<OfSite> of_site_;
};

}  // namespace mpm::core
