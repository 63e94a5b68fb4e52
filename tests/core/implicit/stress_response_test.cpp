// Forces of an implicit step and their derivative, with a law whose stress is known: isotropic, of the total
// deformation gradient.
#include "core/implicit/stress_response.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

namespace mpm::core {
namespace {

/// p = -K ln J, s = 2 G dev(h) of the step alone: depends on h through all of its symmetric part and through
/// J.
class Law final : public ConstitutiveModel {
 public:
  static constexpr double bulk = 7, shear = 3;
  const std::string& name() const override { return name_; }
  ColumnSet columns(const UpdateOptions&) const override { return {}; }
  double initial_sound_speed() const override { return 1; }
  double reference_density() const override { return 1; }
  void initialise(Batch&, const UpdateOptions&) const override {}
  void update(Batch& batch, const UpdateOptions&) const override {
    for (int i = 0; i < block_lanes * batch.blocks; ++i) {
      double* const lane = batch.block[i / block_lanes] + i % block_lanes;
      const auto at = [&](Column c) -> double& { return lane[batch.layout->offset(c)]; };
      const auto h = [&](int n) { return batch.dt * batch.gradient[n][i]; };
      const Mat3<double> half{h(0) / 2, h(1) / 2, h(2) / 2, h(3) / 2, h(4) / 2,
                              h(5) / 2, h(6) / 2, h(7) / 2, h(8) / 2};
      const double j = determinant(plus_unit(half, 1.0)) / determinant(plus_unit(-1.0 * half, 1.0));
      at(Column::volume) *= j;
      at(Column::pressure) = -bulk * std::log(j);
      const double mean = (h(0) + h(4) + h(8)) / 3;
      at(Column::s_xx) = 2 * shear * (h(0) - mean);
      at(Column::s_yy) = 2 * shear * (h(4) - mean);
      at(Column::s_zz) = 2 * shear * (h(8) - mean);
      at(Column::s_xy) = shear * (h(1) + h(3));
      at(Column::s_yz) = shear * (h(5) + h(7));
      at(Column::s_xz) = shear * (h(2) + h(6));
    }
  }

 private:
  std::string name_ = "law";
};

/// A batch of ten particles, the last block of two, with random displacement gradients.
struct Particles {
  ColumnLayout layout{ColumnSet::mechanics()};
  std::vector<double> memory, room;
  Batch batch{};
  Rows9 gradient{};

  explicit Particles(double size) {
    const auto doubles = static_cast<std::size_t>(block_lanes * layout.columns());
    memory.assign(2 * doubles, 0.0);
    room.resize(2 * doubles);
    batch.layout = &layout;
    batch.blocks = 2;
    batch.particles = 10;
    batch.dt = 0.3;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(-size, size);
    for (int b = 0; b < 2; ++b) {
      batch.block[b] = memory.data() + static_cast<std::size_t>(b) * doubles;
      for (int l = 0; l < block_lanes; ++l) batch.block[b][layout.offset(Column::volume) + l] = 2;
    }
    for (double(&row)[batch_particles] : gradient)
      for (int i = 0; i < batch.particles; ++i) row[i] = any(random);
  }
  /// P of every particle at its gradient; the state is restored.
  void stress(Rows9& p) {
    const std::vector<double> before = memory;
    REQUIRE(set_midstep_gradient(gradient, batch));
    Law().update(batch, {});
    nodal_stress(gradient, batch, p);
    memory = before;
  }
};

TEST_CASE("h at midstep gives back the displacement gradient") {
  Particles some(0.4);
  REQUIRE(set_midstep_gradient(some.gradient, some.batch));
  for (int i = 0; i < some.batch.particles; ++i) {
    double h[9];
    for (int n = 0; n < 9; ++n) h[n] = 0.5 * some.batch.dt * some.batch.gradient[n][i];
    const Mat3<double> half{h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8]};
    const Mat3<double> f = inverse(plus_unit(-1.0 * half, 1.0)) * plus_unit(half, 1.0);
    const double each[9] = {f.xx - 1, f.xy, f.xz, f.yx, f.yy - 1, f.yz, f.zx, f.zy, f.zz - 1};
    for (int n = 0; n < 9; ++n) CHECK(each[n] == Approx(some.gradient[n][i]).margin(1e-13));
  }
}

TEST_CASE("A rotation causes no strain, and an inversion is noticed") {
  Particles some(0.0);
  const double c = std::cos(1.1), s = std::sin(1.1);
  for (int i = 0; i < some.batch.particles; ++i) {
    some.gradient[0][i] = some.gradient[4][i] = c - 1;
    some.gradient[1][i] = -s;
    some.gradient[3][i] = s;
  }
  Rows9 p;
  some.stress(p);
  for (int n = 0; n < 9; ++n)
    for (int i = 0; i < some.batch.particles; ++i) CHECK(std::abs(p[n][i]) < 1e-14);
  some.gradient[0][9] = some.gradient[4][9] = 0;
  some.gradient[1][9] = some.gradient[3][9] = 0;
  some.gradient[8][9] = -1.01;
  CHECK_FALSE(set_midstep_gradient(some.gradient, some.batch));
}

TEST_CASE("Stress in uniaxial strain is the force per initial area") {
  Particles some(0.0);
  for (int i = 0; i < some.batch.particles; ++i) some.gradient[0][i] = 0.25;
  Rows9 p;
  some.stress(p);
  const double h = 2 * 0.25 / 2.25, sigma = Law::bulk * std::log(1.25) + 2 * Law::shear * h * 2 / 3;
  CHECK(p[0][0] == Approx(2 * sigma));  // V0 sigma J / J
  const double lateral = Law::bulk * std::log(1.25) - 2 * Law::shear * h / 3;
  CHECK(p[4][0] == Approx(2 * 1.25 * lateral));
}

TEST_CASE("The derivative of the forces is that of their differences") {
  for (const double size : {1e-3, 0.15}) {
    Particles some(size);
    Rows9 p;
    static StressTangent stress;
    static ForceTangent tangent;
    REQUIRE(set_midstep_gradient(some.gradient, some.batch));
    const std::vector<double> before = some.memory;
    difference_tangent(Law(), {}, some.batch, some.room.data(), stress);
    CHECK(some.memory == before);
    Law().update(some.batch, {});
    nodal_stress(some.gradient, some.batch, p);
    force_tangent(some.gradient, some.batch, p, stress, tangent);
    some.memory = before;
    constexpr double step = 1e-5;
    for (int kl = 0; kl < 9; ++kl) {
      Rows9 above, below;
      for (double& g : some.gradient[kl]) g += step;
      some.stress(above);
      for (double& g : some.gradient[kl]) g -= 2 * step;
      some.stress(below);
      for (double& g : some.gradient[kl]) g += step;
      for (int ij = 0; ij < 9; ++ij) {
        for (int i = 0; i < some.batch.particles; ++i) {
          const double difference = (above[ij][i] - below[ij][i]) / (2 * step);
          CHECK(tangent.d[9 * ij + kl][i] == Approx(difference).margin(1e-7 * Law::bulk));
        }
      }
    }
  }
}

}  // namespace
}  // namespace mpm::core
