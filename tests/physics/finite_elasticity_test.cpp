// NeoHookean and Corotated against their energies, evaluated in long double with nothing of the program:
// stress P F^T / J for random F, small strain, work, the acoustic tensor, and inverted states. The rotation
// of Corotated comes from Newton's iteration R <- (R + R^-T)/2 (Higham, SIAM J. Sci. Stat. Comput. 7 (1986)
// 1160).

#include <cmath>
#include <limits>
#include <random>
#include <type_traits>

#include <catch2/catch.hpp>

#include "core/tensor/principal.hpp"
#include "physics/point/point_driver.hpp"
#include "physics/strength/corotated.hpp"
#include "physics/strength/neo_hookean.hpp"
#include "tests/physics/random_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

namespace {

using core::Column;
using core::Mat3;
using core::Real;
using core::Sym3;
using core::Vec3;
using physics::PointDriver;
using physics::StrengthPoint;
using Long = long double;
using Matrix = Mat3<Long>;

constexpr double young = 2.0, density = 1100;
constexpr double every_poisson[] = {-0.4, 0.0, 0.3, 0.49};
const Matrix unit{1, 0, 0, 0, 1, 0, 0, 0, 1};

Matrix transpose(const Matrix& a) { return {a.xx, a.yx, a.zx, a.xy, a.yy, a.zy, a.xz, a.yz, a.zz}; }
/// det(a) a^-T
Matrix cofactor(const Matrix& a) { return transpose(adjugate(a)); }
Long squares(const Matrix& a) {
  const Matrix b = a * transpose(a);
  return b.xx + b.yy + b.zz;
}
Matrix closest_rotation(Matrix r) {
  for (int i = 0; i < 60; ++i) r = 0.5L * (r + 1 / determinant(r) * cofactor(r));
  return r;
}

struct Lame {
  explicit Lame(Long nu) : mu(young / (2 * (1 + nu))), lambda(young * nu / ((1 + nu) * (1 - 2 * nu))) {}
  Long mu, lambda;
};

/// The energy W(F) and the first Piola-Kirchhoff stress dW/dF.
struct ByNeoHookean {
  using Law = physics::NeoHookean;
  static Long energy(const Matrix& f, const Lame& c) {
    const Long ln = std::log(determinant(f));
    return c.mu / 2 * (squares(f) - 3) - c.mu * ln + c.lambda / 2 * ln * ln;
  }
  static Matrix piola(const Matrix& f, const Lame& c) {
    const Long j = determinant(f);
    return c.mu * f + (c.lambda * std::log(j) - c.mu) / j * cofactor(f);
  }
};
struct ByCorotated {
  using Law = physics::Corotated;
  static Long energy(const Matrix& f, const Lame& c) {
    const Long expansion = determinant(f) - 1;
    return c.mu * squares(f - closest_rotation(f)) + c.lambda / 2 * expansion * expansion;
  }
  static Matrix piola(const Matrix& f, const Lame& c) {
    return 2 * c.mu * (f - closest_rotation(f)) + c.lambda * (determinant(f) - 1) * cofactor(f);
  }
};

Matrix rotation(std::mt19937& random) {
  std::normal_distribution<Long> normal;
  Long w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  const Long n = std::sqrt(w * w + x * x + y * y + z * z);
  w /= n, x /= n, y /= n, z /= n;
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
          2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
          2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

/// A deformation gradient and its principal stretches and axes (the columns) in the current state.
struct Deformation {
  Matrix f, axes;
  Long s1, s2, s3;
};
/// Stretches between 0.3 and 3; every third time two, every ninth all of them are equal.
Deformation random_deformation(std::mt19937& random, int i) {
  std::uniform_real_distribution<Long> logarithm(std::log(0.3L), std::log(3.0L));
  Deformation d{unit, rotation(random), std::exp(logarithm(random)), std::exp(logarithm(random)),
                std::exp(logarithm(random))};
  if (i % 3 == 0) d.s2 = d.s3;
  if (i % 9 == 0) d.s1 = d.s2;
  d.f = d.axes * Matrix{d.s1, 0, 0, 0, d.s2, 0, 0, 0, d.s3} * rotation(random);
  return d;
}

template <class T>
StrengthPoint<T> point_at(const Matrix& f) {
  StrengthPoint<T> p{};
  const auto put = [](T& to, Long from) { to = static_cast<double>(from); };
  put(p.f_xx, f.xx), put(p.f_xy, f.xy), put(p.f_xz, f.xz), put(p.f_yx, f.yx), put(p.f_yy, f.yy);
  put(p.f_yz, f.yz), put(p.f_zx, f.zx), put(p.f_zy, f.zy), put(p.f_zz, f.zz);
  p.s = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  p.strain = p.s;
  return p;
}
Matrix deformation_of(const PointDriver& p) {
  return {p.value(Column::f_xx), p.value(Column::f_xy), p.value(Column::f_xz),
          p.value(Column::f_yx), p.value(Column::f_yy), p.value(Column::f_yz),
          p.value(Column::f_zx), p.value(Column::f_zy), p.value(Column::f_zz)};
}

template <class Law>
Law law_of(double poisson) {
  Law law;
  law.young = young, law.poisson = poisson;
  law.prepare();
  return law;
}
core::MaterialInput input_of(std::string_view type, double poisson) {
  core::MaterialInput input;
  input.name = "solid";
  input.reference_density = density;
  input.strength.type = type;
  input.strength.values = {{"Young", young}, {"Poisson", poisson}};
  return input;
}

/// The law's stress at F, of the first lane.
template <class T, class Law>
Matrix stress_of(const Law& law, const Matrix& f) {
  StrengthPoint<T> p = point_at<T>(f);
  law.update(p);
  const auto of = [](const T& v) -> Long {
    if constexpr (std::is_same_v<T, double>) {
      return v;
    } else {
      return v[0];
    }
  };
  return {of(p.s.xx - p.pressure), of(p.s.xy), of(p.s.xz), of(p.s.xy),
          of(p.s.yy - p.pressure), of(p.s.yz), of(p.s.xz), of(p.s.yz),
          of(p.s.zz - p.pressure)};
}
template <class Law>
double longitudinal_modulus(const Law& law, const Matrix& f) {
  StrengthPoint<double> p = point_at<double>(f);
  law.update(p);
  return p.bulk_modulus + 4.0 / 3 * p.shear_modulus;
}

/// Largest value of the acoustic tensor, Q a = d(P F^T n)/d(eta) / J along F + eta a (F^T n), by central
/// differences of the reference's stress.
template <class Reference>
double stiffest(const Matrix& f, const Vec3<Long>& n, const Lame& c) {
  constexpr Long h = 1e-6L;  // truncation error h^2, round-off 1e-19/h
  const Vec3<Long> m{f.xx * n.x + f.yx * n.y + f.zx * n.z, f.xy * n.x + f.yy * n.y + f.zy * n.z,
                     f.xz * n.x + f.yz * n.y + f.zz * n.z};
  const Long per_j = 1 / determinant(f);
  const auto column = [&](const Vec3<Long>& a) {
    const Matrix wave{a.x * m.x, a.x * m.y, a.x * m.z, a.y * m.x, a.y * m.y,
                      a.y * m.z, a.z * m.x, a.z * m.y, a.z * m.z};
    const Matrix d =
        per_j / (2 * h) * (Reference::piola(f + h * wave, c) - Reference::piola(f - h * wave, c));
    return Vec3<double>{static_cast<double>(d.xx * m.x + d.xy * m.y + d.xz * m.z),
                        static_cast<double>(d.yx * m.x + d.yy * m.y + d.yz * m.z),
                        static_cast<double>(d.zx * m.x + d.zy * m.y + d.zz * m.z)};
  };
  const Vec3<double> x = column({1, 0, 0}), y = column({0, 1, 0}), z = column({0, 0, 1});
  return core::principal_values(Sym3<double>{x.x, y.y, z.z, x.y, y.z, x.z}).x;
}

}  // namespace

TEMPLATE_TEST_CASE("the finite elastic stress is P F^T / J of the energy's P", "[physics][finite]",
                   ByNeoHookean, ByCorotated) {
  std::mt19937 random(1);
  Long worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const double nu = every_poisson[i % 4];
    const Lame c(nu);
    // What the law is given: F rounded to double.
    const StrengthPoint<double> rounded = point_at<double>(random_deformation(random, i).f);
    const Matrix f{rounded.f_xx, rounded.f_xy, rounded.f_xz, rounded.f_yx, rounded.f_yy,
                   rounded.f_yz, rounded.f_zx, rounded.f_zy, rounded.f_zz};
    const Long j = determinant(f);
    const Matrix exact = 1 / j * (TestType::piola(f, c) * transpose(f));
    // Round-off of terms of this size: those of B, and those of J in det F, a sum of cubes.
    const Long size = c.mu * (1 + squares(f)) / j * (1 + std::sqrt(squares(f)) * squares(f) / j) +
                      std::abs(c.lambda) * (1 + std::abs(std::log(j)) / j + j + 30 / j);
    const auto law = law_of<typename TestType::Law>(nu);
    worst = std::max(worst, std::sqrt(squares(stress_of<double>(law, f) - exact)) / size);
    worst = std::max(worst, std::sqrt(squares(stress_of<Real>(law, f) - exact)) / size);
  }
  INFO("largest error " << worst);
  CHECK(worst < 1e-15L);
}

TEMPLATE_TEST_CASE("the reference's P is the derivative of its energy", "[physics][finite]", ByNeoHookean,
                   ByCorotated) {
  std::mt19937 random(2);
  for (int i = 0; i < 50; ++i) {
    const Lame c(every_poisson[i % 4]);
    const Matrix f = random_deformation(random, i).f, along = rotation(random);
    constexpr Long h = 1e-6L;
    const Long slope = (TestType::energy(f + h * along, c) - TestType::energy(f - h * along, c)) / (2 * h);
    const Matrix work = TestType::piola(f, c) * transpose(along);
    CHECK(static_cast<double>(slope - work.xx - work.yy - work.zz) == Approx(0).margin(1e-8));
  }
}

TEMPLATE_TEST_CASE("finite elasticity is Hooke's law at small strain", "[physics][finite]", ByNeoHookean,
                   ByCorotated) {
  const Matrix e{0.3L, 0.5L, -0.2L, 0.5L, -0.7L, 0.4L, -0.2L, 0.4L, 0.6L};
  for (const double nu : every_poisson) {
    const Lame c(nu);
    const auto error = [&](Long size) {
      const Matrix hooke = c.lambda * (e.xx + e.yy + e.zz) * unit + 2 * c.mu * e;
      return std::sqrt(
          squares(1 / size * stress_of<double>(law_of<typename TestType::Law>(nu), unit + size * e) - hooke));
    };
    const Long coarse = error(1e-3L), fine = error(1e-5L);
    INFO("Poisson " << nu << ", error " << coarse << " -> " << fine);
    CHECK(static_cast<double>(fine / c.mu) < 1e-3);
    CHECK(static_cast<double>(coarse / fine) == Approx(100).epsilon(0.02));  // what is left is quadratic
  }
}

TEMPLATE_TEST_CASE("finite elasticity stores the energy of its deformation", "[physics][finite][energy]",
                   ByNeoHookean, ByCorotated) {
  for (const double nu : {-0.2, 0.3, 0.45}) {
    const Lame c(nu);
    const auto material = make(input_of(TestType::Law::name, nu));
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const physics::RandomPath path(seed, 1.0, 1.0);
      double largest_strain = 0;
      const auto error = [&](int steps) {
        // The volume of update type 2 is that of F, to second order.
        PointDriver point(*material, {.update = {.volume_update = 2}});
        double worst = 0, most = 0;
        for (int i = 0; i < steps; ++i) {
          point.step(path.gradient((i + 0.5) / steps), 1.0 / steps);
          if ((i + 1) % (steps / 10) != 0) continue;
          const Matrix f = deformation_of(point);
          const double stored = static_cast<double>(TestType::energy(f, c));
          worst = std::max(worst, std::abs(point.energy() - stored)), most = std::max(most, stored);
          largest_strain =
              std::max(largest_strain, static_cast<double>(std::sqrt(squares(f - closest_rotation(f)))));
        }
        return worst / most;
      };
      const double coarse = error(500), fine = error(2000);
      INFO("Poisson " << nu << ", path " << seed << ", error " << coarse << " -> " << fine);
      CHECK(largest_strain > 0.3);
      CHECK(fine < 1e-5);
      CHECK(std::log2(coarse / fine) / 2 > 1.9);
    }
  }
}

TEMPLATE_TEST_CASE("no wave is faster than finite elasticity states", "[physics][finite][wave]", ByNeoHookean,
                   ByCorotated) {
  std::mt19937 random(4);
  std::normal_distribution<Long> normal;
  for (int i = 0; i < 120; ++i) {
    const double nu = every_poisson[(i / 3) % 4];
    const Lame c(nu);
    const Deformation d = random_deformation(random, i);
    const double stated = longitudinal_modulus(law_of<typename TestType::Law>(nu), d.f);
    double fastest = 0;
    const auto wave = [&](const Vec3<Long>& n) {
      fastest = std::max(fastest, stiffest<TestType>(d.f, 1 / std::sqrt(dot(n, n)) * n, c));
    };
    wave({d.axes.xx, d.axes.yx, d.axes.zx});
    wave({d.axes.xy, d.axes.yy, d.axes.zy});
    wave({d.axes.xz, d.axes.yz, d.axes.zz});
    for (int k = 0; k < 20; ++k) wave({normal(random), normal(random), normal(random)});
    INFO("Poisson " << nu << ", stretches " << d.s1 << " " << d.s2 << " " << d.s3);
    CHECK(fastest <= stated * (1 + 1e-9));
    // Sharp: Corotated without negative lambda, NeoHookean where the two smaller stretches are equal.
    const bool sharp = TestType::Law::name == "Corotated" ? nu >= 0 : d.s2 == d.s3 && d.s1 >= d.s2;
    if (sharp) CHECK(fastest == Approx(stated).epsilon(1e-8));
  }
}

TEMPLATE_TEST_CASE("a finite elastic particle placed at another density has that density's stress and energy",
                   "[physics][finite]", ByNeoHookean, ByCorotated) {
  for (const double nu : every_poisson) {
    const auto material = make(input_of(TestType::Law::name, nu));
    const Long stretch = std::cbrt(1 / 1.3L);
    PointDriver placed(*material, {.density = 1.3 * density});
    const Matrix f = stretch * unit, piola = TestType::piola(f, Lame(nu));
    CHECK(placed.value(Column::pressure) ==
          Approx(static_cast<double>(-piola.xx / (stretch * stretch))).epsilon(1e-12));
    CHECK(placed.energy() == Approx(static_cast<double>(TestType::energy(f, Lame(nu)))).epsilon(1e-12));
    CHECK(contract(placed.deviator(), placed.deviator()) == 0);
    const double modulus = young * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
    // Corotated's bound is above the longitudinal modulus at rest where lambda is negative.
    if (nu >= 0 || TestType::Law::name == "NeoHookean")
      CHECK(material->initial_sound_speed() == Approx(std::sqrt(modulus / density)).epsilon(1e-12));
  }
}

TEMPLATE_TEST_CASE("an inverted finite elastic particle is refused, or not finite", "[physics][finite]",
                   ByNeoHookean, ByCorotated) {
  const auto material = make(input_of(TestType::Law::name, 0.3));
  PointDriver point(*material, {});
  point.step({-3, 0, 0, 0, 0, 0, 0, 0, 0}, 1);
  CHECK(point.value(Column::f_xx) == 1);
  CHECK(point.events().negative_volume == 1);
  CHECK(point.events().not_finite == 0);
  CHECK(std::isfinite(point.stress().xx));
  for (const double stretch : {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    for (const double poisson : every_poisson) {
      const auto solid = make(input_of(TestType::Law::name, poisson));
      PointDriver inverted(*solid, {});
      inverted.set(Column::f_xx, stretch);
      inverted.step({}, 1);
      INFO("stretch " << stretch << ", Poisson " << poisson);
      CHECK(inverted.events().not_finite == 1);
      CHECK_FALSE(std::isfinite(inverted.stress().xx));
    }
  }
}

}  // namespace mpm::tests
