// Volume changes averaged over the particles of one body in a site (Solution/Volumetric averaging="cell";
// sites as in core/step/site_averages.hpp) in implicit steps, where they may be large. With F_p the
// deformation in the step, J_p its determinant, V_p the volume at its start, W_p = F_p^-T and means over the
// particles of site c weighted with V_p, the law receives
//   Fm_p = (J_c/J_p)^1/3 F_p,   J_c = mean of J_p
// (F-bar: Moran, Ortiz and Shih, IJNME 29 (1990) 483; here with the mean dilatation), and forces follow from
//   P_p = (V_p J_c dev sigma_p + V_p J_p s_c I) W_p,   s_c = mean of tr sigma_p/3
// which makes them the derivative of the energy that a hyperelastic law stores at Fm. Their derivative is,
// with the law's own Dm = d Pm/d Fm of Pm = V_p J_c sigma Fm^-T, a = (J_c/J_p)^1/3, T = (Pm + Fm:Dm)/3, s =
// T:Fm/3,
//   dP_p  = K_p dF_p + g_p dln J_c + V_p J_p W_p ds_c
//   K_p   = a (a Dm - (Dm:Fm + Pm) W/3) + (V J_p s_c - Pm:Fm/3) dW/dF + W (V J_p s_c W - m_p)
//   g_p   = a (Dm:Fm + Pm)/3 - s W,   m_p = a T - s W
//   dln J_c = sum V_p J_p W_p:dF_p / G,   G = sum V_p J_p
//   ds_c  = (sum m_p:dF_p + (sum s_p - s_c G) dln J_c)/G
// so that the particles of a site are coupled by products of three vectors over its nodes, e of V J_p W_p, g
// and m:   K = sum K_p + (g e^T + e m^T + (sum s_p/G - s_c) e e^T)/G.
// Tested by tests/core/implicit/site_dilatation_test.cpp.
#pragma once

#include <span>
#include <vector>

#include "core/implicit/stress_response.hpp"

namespace mpm::core {

class SiteDilatation {
 public:
  /// Sums over a site's particles: sum_p over B_p^T e_p and so on, by node.
  struct OfNode {
    int node;
    Vec3<double> growth{}, before{}, after{};  ///< e, g, m
  };
  struct Site {
    double volume = 0, grown = 0;  ///< sums of V_p and of V_p J_p
    double stress = 0;             ///< sum of V_p tr sigma_p/3
    double second = 0;             ///< sum of s_p
    std::vector<OfNode> nodes;

    double dilatation() const { return grown / volume; }
    double mean_stress() const { return stress / volume; }
    /// `at`: where the node probably is, as particles of a site have the same nodes in the same order.
    OfNode& of(int node, std::size_t at) {
      if (at < nodes.size() && nodes[at].node == node) return nodes[at];
      for (OfNode& each : nodes)
        if (each.node == node) return each;
      return nodes.emplace_back(OfNode{node});
    }
  };

  /// Forgets all, for a tile in a brick of so many sites.
  void begin(int sites) {
    for (Site& each : used()) {
      each.nodes.clear();
      each = {0, 0, 0, 0, std::move(each.nodes)};
    }
    count_ = 0;
    index_.assign(static_cast<std::size_t>(sites), -1);
  }
  Site& of(int site) {
    std::int32_t& index = index_[static_cast<std::size_t>(site)];
    if (index < 0) {
      index = static_cast<std::int32_t>(count_++);
      if (sites_.size() < count_) sites_.emplace_back();
    }
    return sites_[static_cast<std::size_t>(index)];
  }
  std::span<Site> used() { return {sites_.data(), count_}; }
  std::span<const Site> used() const { return {sites_.data(), count_}; }

 private:
  std::vector<std::int32_t> index_;  ///< by site, in sites_
  std::vector<Site> sites_;
  std::size_t count_ = 0;
};

/// F, its determinant and W of a particle of a batch.
struct Deformation {
  Mat3<double> f, w;
  double j;
  Deformation(const Rows9& displacement_gradient, int i);
};

/// Fm - I of particle i. False where it inverts.
bool average_gradient(const Deformation& particle, double dilatation, int i, Rows9& averaged);

/// V_p J_c dev sigma_p W_p of particle i, from the updated columns.
void deviatoric_stress(const Deformation& particle, const Batch& batch, int i, Rows9& p);
double mean_stress(const Batch& batch, int i);

/// What a particle contributes to a site's stiffness.
struct DilatationTangent {
  Mat3<double> growth, before, after;  ///< V J_p W, g, m
  double second;                       ///< s
};
/// Replaces Dm of particle i in `tangent` by K. `p`: its Pm; `averaged`: Fm - I; `volume`: V_p.
DilatationTangent dilatation_tangent(const Deformation& particle, const SiteDilatation::Site& site,
                                     double volume, int i, const Rows9& averaged, const Rows9& p,
                                     ForceTangent& tangent);

}  // namespace mpm::core
