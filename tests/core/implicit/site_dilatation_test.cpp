// Averaged volume changes of implicit steps: forces against differences of the stored energy, and their
// derivative, with its couplings of the particles of a site, against differences of the forces.
#include "core/implicit/site_dilatation.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

namespace mpm::core {
namespace {

constexpr double bulk = 50, shear = 3, dt = 0.3;

/// Neo-Hookean from a state without strain, W = G/2 (J^-2/3 F:F - 3) + K/2 (ln J)^2 per initial volume.
double energy(const Mat3<double>& f) {
  const double j = determinant(f);
  const double square = f.xx * f.xx + f.xy * f.xy + f.xz * f.xz + f.yx * f.yx + f.yy * f.yy + f.yz * f.yz +
                        f.zx * f.zx + f.zy * f.zy + f.zz * f.zz;
  return shear / 2 * (std::pow(j, -2.0 / 3) * square - 3) + bulk / 2 * std::log(j) * std::log(j);
}

class Law final : public ConstitutiveModel {
 public:
  const std::string& name() const override { return name_; }
  ColumnSet columns(const UpdateOptions&) const override { return {}; }
  double initial_sound_speed() const override { return 1; }
  double reference_density() const override { return 1; }
  void initialise(Batch&, const UpdateOptions&) const override {}
  void update(Batch& batch, const UpdateOptions&) const override {
    for (int i = 0; i < block_lanes * batch.blocks; ++i) {
      double* const lane = batch.block[i / block_lanes] + i % block_lanes;
      const auto at = [&](Column c) -> double& { return lane[batch.layout->offset(c)]; };
      const auto h = [&](int n) { return 0.5 * batch.dt * batch.gradient[n][i]; };
      const Mat3<double> half{h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), h(8)};
      const Mat3<double> f = inverse(plus_unit(-1.0 * half, 1.0)) * plus_unit(half, 1.0);
      const double j = determinant(f), k = shear * std::pow(j, -5.0 / 3);
      const Mat3<double> b = f * transposed(f);
      const double third = (b.xx + b.yy + b.zz) / 3;
      at(Column::volume) *= j;
      at(Column::pressure) = -bulk * std::log(j) / j;
      at(Column::s_xx) = k * (b.xx - third);
      at(Column::s_yy) = k * (b.yy - third);
      at(Column::s_zz) = k * (b.zz - third);
      at(Column::s_xy) = k * b.xy;
      at(Column::s_yz) = k * b.yz;
      at(Column::s_xz) = k * b.xz;
    }
  }

 private:
  std::string name_ = "law";
};

/// Twelve particles of different volumes in two sites.
struct Sites {
  ColumnLayout layout{ColumnSet::mechanics()};
  std::vector<double> memory, room;
  Batch batch{};
  Rows9 gradient{}, averaged{}, p{};
  SiteDilatation sites;
  bool usable = true;
  static int site_of(int i) { return i % 3 == 0 ? 4 : 1; }

  explicit Sites(double size) {
    const auto doubles = static_cast<std::size_t>(block_lanes * layout.columns());
    memory.assign(2 * doubles, 0.0);
    room.resize(2 * doubles);
    batch.layout = &layout;
    batch.blocks = 2;
    batch.particles = 12;
    batch.dt = dt;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(-size, size), part(0.5, 1.5);
    for (int b = 0; b < 2; ++b) {
      batch.block[b] = memory.data() + static_cast<std::size_t>(b) * doubles;
      for (int l = 0; l < block_lanes; ++l) batch.block[b][layout.offset(Column::volume) + l] = part(random);
    }
    for (double(&row)[batch_particles] : gradient)
      for (int i = 0; i < batch.particles; ++i) row[i] = any(random);
  }
  double volume(int i) const {
    return batch.block[i / block_lanes][layout.offset(Column::volume) + i % block_lanes];
  }
  void average() {
    sites.begin(5);
    for (int i = 0; i < batch.particles; ++i) {
      SiteDilatation::Site& site = sites.of(site_of(i));
      site.volume += volume(i);
      site.grown += volume(i) * Deformation(gradient, i).j;
    }
    usable = true;
    for (int i = 0; i < batch.particles; ++i)
      usable = average_gradient({gradient, i}, sites.of(site_of(i)).dilatation(), i, averaged) && usable;
    usable = set_midstep_gradient(averaged, batch) && usable;
  }
  double stored() {
    average();
    double sum = 0;
    for (int i = 0; i < batch.particles; ++i)
      sum += volume(i) * energy(plus_unit(load_rows<double>(averaged, i), 1.0));
    return sum;
  }
  /// P of all particles; the columns hold the state at the end of the step.
  void update() {
    const std::vector<double> before = memory;
    average();
    Law().update(batch, {});
    for (int i = 0; i < batch.particles; ++i) {
      SiteDilatation::Site& site = sites.of(site_of(i));
      const double jacobian = site.dilatation();
      site.stress += volume(i) / jacobian * mean_stress(batch, i);
    }
    for (int i = 0; i < batch.particles; ++i) {
      const Deformation particle(gradient, i);
      const SiteDilatation::Site& site = sites.of(site_of(i));
      deviatoric_stress(particle, batch, i, p);
      const double grown = volume(i) / site.dilatation() * particle.j;
      store_rows(load_rows<double>(p, i) + grown * site.mean_stress() * particle.w, p, i);
    }
    after = memory;
    memory = before;
  }
  std::vector<double> after;
};

TEST_CASE("Averaging leaves a uniform strain alone, and the volume of a site") {
  Sites uniform(0.0);
  for (int i = 0; i < uniform.batch.particles; ++i) {
    uniform.gradient[0][i] = 0.2;
    uniform.gradient[5][i] = -0.3;
  }
  uniform.average();
  for (int n = 0; n < 9; ++n)
    for (int i = 0; i < uniform.batch.particles; ++i)
      CHECK(uniform.averaged[n][i] == Approx(uniform.gradient[n][i]).margin(1e-15));

  Sites any(0.1);
  any.average();
  double own = 0, averaged = 0;
  for (int i = 0; i < any.batch.particles; ++i) {
    own += any.volume(i) * Deformation(any.gradient, i).j;
    averaged += any.volume(i) * Deformation(any.averaged, i).j;
  }
  CHECK(averaged == Approx(own));
}

TEST_CASE("Averaging notices a particle that inverts in a site that grows") {
  Sites some(0.0);
  some.gradient[0][2] = -1.5;
  some.average();
  CHECK_FALSE(some.usable);
}

TEST_CASE("The forces of averaged volume changes are the derivative of the stored energy") {
  Sites some(0.1);
  some.update();
  constexpr double step = 1e-5;
  for (int kl = 0; kl < 9; ++kl) {
    for (int i = 0; i < some.batch.particles; ++i) {
      double& g = some.gradient[kl][i];
      g += step;
      const double above = some.stored();
      g -= 2 * step;
      const double below = some.stored();
      g += step;
      CHECK(some.p[kl][i] == Approx((above - below) / (2 * step)).margin(1e-7 * bulk));
    }
  }
}

TEST_CASE("The derivative of these forces, within a particle and between those of a site") {
  Sites some(0.1);
  static StressTangent stress;
  static ForceTangent tangent;
  const std::vector<double> before = some.memory;
  some.update();
  difference_tangent(Law(), {}, some.batch, some.room.data(), stress);
  some.memory = some.after;
  Rows9 pm;
  nodal_stress(some.averaged, some.batch, pm);
  force_tangent(some.averaged, some.batch, pm, stress, tangent);
  some.memory = before;
  std::vector<DilatationTangent> of;
  for (int i = 0; i < some.batch.particles; ++i) {
    SiteDilatation::Site& site = some.sites.of(Sites::site_of(i));
    of.push_back(dilatation_tangent({some.gradient, i}, site, some.volume(i), i, some.averaged, pm, tangent));
    site.second += of.back().second;
  }
  const auto each = [](const Mat3<double>& m, int n) {
    const double all[9] = {m.xx, m.xy, m.xz, m.yx, m.yy, m.yz, m.zx, m.zy, m.zz};
    return all[n];
  };
  struct Of {
    double grown, stress, second;
  };
  Of sites[5];
  for (const int c : {1, 4})
    sites[c] = {some.sites.of(c).grown, some.sites.of(c).mean_stress(), some.sites.of(c).second};
  constexpr double step = 1e-5;
  for (int q = 0; q < some.batch.particles; ++q) {
    for (int kl = 0; kl < 9; ++kl) {
      double& g = some.gradient[kl][q];
      g += step;
      some.update();
      Rows9 above;
      for (int n = 0; n < 9; ++n) std::copy_n(some.p[n], batch_particles, above[n]);
      g -= 2 * step;
      some.update();
      g += step;
      for (int i = 0; i < some.batch.particles; ++i) {
        for (int ij = 0; ij < 9; ++ij) {
          double mine = i == q ? tangent.d[9 * ij + kl][i] : 0;
          if (Sites::site_of(i) == Sites::site_of(q)) {
            const Of& c = sites[Sites::site_of(q)];
            const double e = each(of[static_cast<std::size_t>(i)].growth, ij),
                         b = each(of[static_cast<std::size_t>(i)].before, ij);
            const DilatationTangent& other = of[static_cast<std::size_t>(q)];
            mine += (b * each(other.growth, kl) + e * each(other.after, kl) +
                     (c.second / c.grown - c.stress) * e * each(other.growth, kl)) /
                    c.grown;
          }
          const double difference = (above[ij][i] - some.p[ij][i]) / (2 * step);
          CHECK(mine == Approx(difference).margin(2e-7 * bulk));
        }
      }
    }
  }
}

}  // namespace
}  // namespace mpm::core
