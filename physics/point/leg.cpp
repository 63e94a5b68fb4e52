#include "physics/point/leg.hpp"

#include <utility>

namespace mpm::physics {

using core::Mat3;
using core::Sym3;

double weighted(const Sym3<double>& w, const Sym3<double>& t) {
  return w.xx * t.xx + w.yy * t.yy + w.zz * t.zz + w.xy * t.xy + w.yz * t.yz + w.xz * t.xz;
}

namespace legs {

namespace {

Leg leg(std::string kind, const Mat3<double>& direction, const Sym3<double>& measure, double strain) {
  Leg made;
  made.kind = std::move(kind);
  made.direction = direction;
  made.measure = measure;
  made.strain = strain;
  return made;
}

constexpr Mat3<double> axial{1, 0, 0, 0, 0, 0, 0, 0, 0};
constexpr Sym3<double> along_x{1, 0, 0, 0, 0, 0};
// Two equal lateral directions form one unknown, measured by their mean.
constexpr StressControl lateral{{0, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0.5, 0.5, 0, 0, 0}, 0, false};

}  // namespace

Leg uniaxial_strain(double strain) { return leg("uniaxial_strain", axial, along_x, strain); }

Leg uniaxial_stress(double strain) {
  Leg made = leg("uniaxial_stress", axial, along_x, strain);
  made.controls = {lateral};
  return made;
}

Leg triaxial(double strain, double confining_pressure) {
  Leg made = leg("triaxial", axial, along_x, strain);
  made.controls = {lateral};
  made.controls[0].target = -confining_pressure;
  return made;
}

Leg biaxial(double strain, double confining_pressure) {
  Leg made = leg("biaxial", axial, along_x, strain);
  made.controls = {{{0, 0, 0, 0, 1, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0}, -confining_pressure, false}};
  return made;
}

Leg equibiaxial(double strain) {
  Leg made = leg("equibiaxial", {1, 0, 0, 0, 1, 0, 0, 0, 0}, along_x, strain);
  made.controls = {{{0, 0, 0, 0, 0, 0, 0, 0, 1}, {0, 0, 1, 0, 0, 0}, 0, false}};
  return made;
}

Leg simple_shear(double gamma) {
  return leg("simple_shear", {0, 1, 0, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 2, 0, 0}, gamma);
}

Leg hydrostatic(double strain) {
  constexpr double third = 1.0 / 3.0;
  return leg("hydrostatic", {third, 0, 0, 0, third, 0, 0, 0, third}, {1, 1, 1, 0, 0, 0}, strain);
}

Leg pressure(double pressure, double time) {
  constexpr double third = 1.0 / 3.0;
  Leg made = hydrostatic(0);
  made.kind = "pressure";
  made.strain.reset();
  made.time = time;
  made.controls = {{made.direction, {third, third, third, 0, 0, 0}, -pressure, true}};
  return made;
}

Leg hold(double time) {
  Leg made;
  made.kind = "hold";
  made.time = time;
  return made;
}

}  // namespace legs

}  // namespace mpm::physics
