#include "core/implicit/rigid_contact.hpp"

#include <algorithm>
#include <cmath>

#include "core/contact/component_contact.hpp"

namespace mpm::core {

RigidContact::RigidContact(Model& model, RigidBodies& rigid, double stiffness)
    : model_(model),
      rigid_(rigid),
      k_(rigidity * stiffness),
      pairs_(model.scene->components.size()),
      body_(rigid.count()),
      friction_(rigid.count()) {
  std::size_t material = 0;
  for (const Body& body : model.bodies) {
    if (body.rigid) continue;
    material = static_cast<std::size_t>(body.material);
    material_component_ = body.component;
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const int number = rigid.of_body(static_cast<int>(b));
    if (number < 0) continue;
    body_[static_cast<std::size_t>(number)] = static_cast<int>(b);
    friction_[static_cast<std::size_t>(number)] =
        friction_of(*model.scene, material, static_cast<std::size_t>(model.bodies[b].material));
  }
}

void RigidContact::begin_step(const Loads& loads, double dt) {
  const Vec3<double> gravity = model_.scene->solution.gravity;
  if (step_ == model_.clock.step)
    rigid_.shorten_step(loads, gravity, dt);
  else
    rigid_.begin_step(loads, gravity, dt);
  step_ = model_.clock.step;
  dt_ = dt;
}

void RigidContact::find_nodes(ImplicitPasses& passes, NodeUnknowns& unknowns) {
  // Of a body's volume around a node over that of a cell: at its corners it is an eighth, at its faces a
  // half; beyond them it is less. Inside, where wide shape functions of the material still reach, the body's
  // surface has no direction, and that of the material counts.
  constexpr double least_volume = 0.1, inside = 0.9;
  touches_.clear();
  passes.map_surface(ImplicitPasses::no_body);
  unknowns.exchange(mapped::implicit_surface);
  // A symmetry plane continues what is behind it.
  const auto surface_of = [&](std::size_t i, const double* sum) {
    Vec3<double> surface{};
    for (int a = 0; a < 3; ++a)
      if ((unknowns.held()[i] >> a & 1) == 0) surface[a] = sum[a];
    return surface;
  };
  std::vector<Vec3<double>> outward(unknowns.own());
  unknowns.for_each_own([&](std::size_t i, const double* sum) { outward[i] = surface_of(i, sum); });
  const double whole = model_.grid->geometry().cell_volume();
  for (std::size_t r = 0; r < body_.size(); ++r) {
    passes.map_surface(body_[r]);
    unknowns.exchange(mapped::implicit_surface);
    const RigidState& state = rigid_.state(static_cast<int>(r));
    const Mat3<double> turn = rotation(dt_ * state.spin);
    unknowns.for_each_own([&](std::size_t i, const double* sum) {
      const double volume = sum[node_field::mass.first];
      if (volume < least_volume * whole) return;
      const Vec3<double> surface = volume < inside * whole ? surface_of(i, sum) : -1.0 * outward[i];
      const double length = std::sqrt(dot(surface, surface));
      if (!(length > 0)) return;
      const double* at = unknowns.coordinates().data() + 3 * i;
      const Vec3<double> x{at[0], at[1], at[2]}, arm = x - state.centre;
      Touch touch{i,
                  static_cast<int>(r),
                  x,
                  (1 / length) * surface,
                  dt_ * state.velocity + turn * arm - arm,
                  friction_[r]};
      touch.sticks = touch.coefficient > 0;
      const auto last = last_.find({static_cast<int>(r), x.x, x.y, x.z});
      if (last != last_.end()) std::tie(touch.sticks, touch.friction) = last->second;
      touches_.push_back(touch);
    });
  }
}

namespace {

constexpr Mat3<double> unit{1, 0, 0, 0, 1, 0, 0, 0, 1};

Mat3<double> outer(const Vec3<double>& a, const Vec3<double>& b) {
  return {a.x * b.x, a.x * b.y, a.x * b.z, a.y * b.x, a.y * b.y, a.y * b.z, a.z * b.x, a.z * b.y, a.z * b.z};
}

}  // namespace

RigidContact::Response RigidContact::response(const Touch& touch, const Vec3<double>& u) const {
  const Vec3<double>& n = touch.normal;
  const Vec3<double> d = u - touch.way;
  Response found;
  found.pressure = std::max(0.0, -k_ * dot(d, n));
  found.force = found.pressure * n - touch.friction;
  if (found.pressure > 0) found.stiffness = k_ * outer(n, n);
  if (!touch.sticks) return found;
  found.force = found.force - k_ * (d - dot(d, n) * n);
  found.stiffness = found.stiffness + k_ * (unit - outer(n, n));
  return found;
}

namespace {
/// How often in a step a node changes between sticking and sliding; and after how many solutions its pressure
/// is the mean of the last two.
constexpr int most_turns = 4, steady = 10;
}  // namespace

RigidContact::Changes RigidContact::find_friction(std::span<const double> u, double relaxation) {
  Changes changes;
  next_ = touches_;
  for (Touch& touch : next_) {
    if (touch.coefficient == 0) continue;
    const Vec3<double> at = displacement(u, touch.node), d = at - touch.way;
    const Vec3<double> slip = d - dot(d, touch.normal) * touch.normal;
    const bool sticking = touch.sticks;
    const double pressure = response(touch, at).pressure;
    touch.pressure = touch.solutions++ < steady ? pressure : 0.5 * (touch.pressure + pressure);
    const double most = touch.coefficient * touch.pressure;
    const Vec3<double> before = sticking ? k_ * slip : touch.friction;
    // Friction grows with the slip up to its bound. A node that slides and has turned round sticks; one that
    // has done so several times goes on sliding, as little as it may.
    touch.sticks =
        sticking ? dot(before, before) <= most * most : touch.turns < most_turns && dot(slip, before) < 0;
    const Vec3<double> wanted = sticking ? before : before + relaxation * slip;
    const double length = std::sqrt(dot(wanted, wanted));
    touch.friction = touch.sticks ? Vec3<double>{} : (length > most ? most / length : 1.0) * wanted;
    const Vec3<double> change = (touch.sticks ? Vec3<double>{} : touch.friction) - before;
    if (touch.sticks != sticking) ++touch.turns;
    if (!(touch.sticks && sticking)) changes.change.add(std::sqrt(dot(change, change)));
    changes.most.add(most);
  }
  return changes;
}

void RigidContact::keep_friction() {
  last_.clear();
  for (const Touch& touch : touches_)
    if (touch.coefficient > 0)
      last_[{touch.body, touch.place.x, touch.place.y, touch.place.z}] = {touch.sticks, touch.friction};
}

void RigidContact::end_step(std::span<const double> u, std::span<const Exerted> exerted, StepStatistics& to) {
  to.contact.impulses.resize(3 * pairs_.size());
  impulses_.assign(rigid_.count(), {});
  for (std::size_t t = 0; t < touches_.size(); ++t) {
    const Touch& touch = touches_[t];
    const auto number = static_cast<std::size_t>(touch.body);
    const Vec3<double> way = touch.way, d = displacement(u, touch.node) - way;
    const Vec3<double> force = exerted[t].force, mean = exerted[t].mean, stop = exerted[t].stop;
    const Vec3<double> impulse = -1.0 * (dt_ * force + stop);  // on the body
    if (impulse == Vec3<double>{}) continue;
    const double by_stop = dot(stop, way) / dt_;  // work of the body
    impulses_[number].add(impulse, touch.place - rigid_.state(touch.body).centre, -dot(mean, way) - by_stop);
    const double rubbed = dot(mean, dot(d, touch.normal) * touch.normal - d);
    to.contact.dissipated.add(-dot(mean, d));
    to.contact.dissipated.add(by_stop - exerted[t].gained);
    to.contact.friction_heat.add(rubbed);
    const std::int32_t component = model_.bodies[static_cast<std::size_t>(body_[number])].component;
    const auto [first, second] = std::minmax(component, material_component_);
    const int pair = pairs_.number(first, second);
    if (pair >= 0) to.contact.add_impulse(pair, second == component ? impulse : -1.0 * impulse);
  }
  rigid_.end_step(impulses_, to.work, to.contact);
  rigid_.set_velocities();
}

std::unique_ptr<RigidContact> make_rigid_contact(Model& model, RigidBodies* rigid, double stiffness) {
  if (rigid == nullptr) return nullptr;
  return std::make_unique<RigidContact>(model, *rigid, stiffness);
}

}  // namespace mpm::core
