#include "core/implicit/implicit_contact.hpp"

#include <cmath>
#include <limits>
#include <set>

#include "core/contact/component_contact.hpp"
#include "core/contact/node_contact.hpp"

namespace mpm::core {

namespace {

Vec3<double> vector_of(const double* from) { return {from[0], from[1], from[2]}; }

/// Of two vectors what they have in common: by component the smaller one, where both have the same sign.
Vec3<double> common(const Vec3<double>& a, const Vec3<double>& b) {
  Vec3<double> both{};
  for (int i = 0; i < 3; ++i)
    if (a[i] * b[i] > 0) both[i] = std::abs(a[i]) < std::abs(b[i]) ? a[i] : b[i];
  return both;
}

double cosine(const Vec3<double>& a, const Vec3<double>& b) {
  const double lengths = std::sqrt(dot(a, a) * dot(b, b));
  return lengths > 0 ? dot(a, b) / lengths : 0;
}

/// The square of a gradient's change over a cell.
double steepness(const Vec3<double>& gradient, const Vec3<double>& cell) {
  double square = 0;
  for (int a = 0; a < 3; ++a) square += cell[a] * gradient[a] * cell[a] * gradient[a];
  return square;
}

/// Of two normals that should be one, that of the steeper gradient. Between them the weight passes over
/// steadily: a normal that jumps from step to step keeps friction from settling.
Vec3<double> of_the_steeper(const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& cell) {
  constexpr double steepest = 8;
  const double of_a = steepness(a, cell), of_b = steepness(b, cell), longer = std::max(of_a, of_b);
  if (!(longer > 0)) return {};
  const double weight = std::pow(std::min(of_a, of_b) / longer, steepest);
  return (of_a < of_b ? weight : 1) * a + (of_a < of_b ? 1 : weight) * b;
}

}  // namespace

ImplicitContact::ImplicitContact(Model& model, RigidBodies* rigid, NodeUnknowns& unknowns)
    : model_(model), rigid_(rigid), unknowns_(unknowns), pairs_(model.scene->components.size()) {
  const Scene& scene = *model.scene;
  const std::size_t components = scene.components.size();
  const double h = model.grid->geometry().smallest_cell();
  stiffness_.assign(components, 0.0);
  weight_.assign(components, -std::numeric_limits<double>::infinity());
  std::vector<int> material(components, -1);
  for (const Body& body : model.bodies) {
    const auto c = static_cast<std::size_t>(body.component);
    material[c] = body.material;
    if (body.rigid) continue;
    const double speed = body.model->initial_sound_speed();
    stiffness_[c] = std::max(stiffness_[c], body.model->reference_density() * speed * speed * h);
    weight_[c] = std::max(weight_[c], normal_weight(scene, c, static_cast<std::size_t>(body.material)));
  }
  if (rigid_ != nullptr) at_faces_.assign(rigid_->count(), false);
  friction_.assign(components * components, {});
  for (std::size_t a = 0; a < components; ++a)
    for (std::size_t b = 0; b < components; ++b)
      if (material[a] >= 0 && material[b] >= 0)
        friction_[a * components + b] =
            friction_of(scene, static_cast<std::size_t>(material[a]), static_cast<std::size_t>(material[b]));
}

void ImplicitContact::begin_step(const Loads& loads, double dt) {
  const Vec3<double> gravity = model_.scene->solution.gravity;
  if (rigid_ != nullptr && step_ == model_.clock.step)
    rigid_->shorten_step(loads, gravity, {.dt = dt, .velocity_dt = dt});
  else if (rigid_ != nullptr)
    rigid_->begin_step(loads, gravity, {.dt = dt, .velocity_dt = dt});
  step_ = model_.clock.step;
  dt_ = dt;
  if (rigid_ != nullptr) impulses_.assign(rigid_->count(), {});
}

/// Own nodes that several components reach, each once.
std::vector<ImplicitContact::Meeting> ImplicitContact::find_meetings(ImplicitPasses& passes) {
  passes.map_surface();
  unknowns_.exchange(mapped::implicit_surface);
  const BrickGrid& grid = *model_.grid;
  const auto doubles = static_cast<std::size_t>(node_doubles * grid.shape().nodes());
  std::vector<Meeting> meetings;
  std::set<std::array<std::int32_t, 3>> known;
  std::vector<std::int32_t> seen;  // components in the neighbourhood of the current brick
  std::vector<double> sums;        // of each
  Slot of = no_slot;
  for (std::size_t i = 0; i < unknowns_.own(); ++i) {
    const NodeUnknowns::Copy here = unknowns_.own_copy(i);
    if (here.slot != of) {
      of = here.slot;
      std::set<std::int32_t> all;
      for (const Slot neighbour : grid.brick(of).neighbour)
        if (neighbour != no_slot)
          all.insert(grid.components(neighbour).begin(), grid.components(neighbour).end());
      seen.assign(all.begin(), all.end());
      sums.resize(seen.size() * doubles);
      for (std::size_t c = 0; seen.size() > 1 && c < seen.size(); ++c) {
        double* const sum = sums.data() + c * doubles;
        unknowns_.sums({of, 0, seen[c], 0}, sum);
        // A wall continues what is behind it.
        BoundaryFaces(grid, of).for_each_node(sum, [](int axis, int, Boundary, double* at) { at[axis] = 0; });
      }
    }
    if (seen.size() < 2) continue;
    Meeting meeting{vector_of(unknowns_.coordinates().data() + 3 * i), {}};
    for (std::size_t c = 0; c < seen.size(); ++c) {
      const double* sum = sums.data() + c * doubles + node_doubles * here.node;
      const double volume = sum[node_field::mass.first];
      if (volume > 0)
        meeting.surfaces.push_back(
            {seen[c], volume, vector_of(sum), unknowns_.owner(of, here.node, seen[c])});
    }
    if (meeting.surfaces.size() < 2) continue;
    const std::int32_t* at = unknowns_.lattice().data() + 3 * i;
    if (known.insert({at[0], at[1], at[2]}).second) meetings.push_back(std::move(meeting));
  }
  return meetings;
}

/// Its number; no_own where the component has no unknown there.
std::size_t ImplicitContact::add_member(const Surface& surface, const Vec3<double>& place) {
  Member member;
  member.component = surface.component;
  member.rigid = rigid(surface.component);
  member.at = surface.at;
  if (member.rigid >= 0) {
    const RigidState& state = rigid_->state(member.rigid);
    const Vec3<double> arm = place - state.centre;
    member.held = 7;
    member.mass = std::numeric_limits<double>::infinity();
    member.displacement = dt_ * state.velocity + rotation(dt_ * state.spin) * arm - arm;
    member.velocity = (1 / dt_) * member.displacement;
  } else {
    const double* shared = unknowns_.shared(surface.at);
    member.number = static_cast<std::int64_t>(shared[0]) - 1;
    if (member.number < 0) return no_own;
    const std::int64_t own = member.number - unknowns_.first();
    if (own >= 0 && own < static_cast<std::int64_t>(unknowns_.own()))
      member.own = static_cast<std::size_t>(own);
    member.held = static_cast<std::uint8_t>(shared[1]);
    member.mass = shared[2];
  }
  members_.push_back(member);
  return members_.size() - 1;
}

void ImplicitContact::find_nodes(ImplicitPasses& passes, std::span<const double> mass) {
  const std::vector<Meeting> meetings = find_meetings(passes);
  unknowns_.share([&](std::size_t i, double* record) {
    record[0] = static_cast<double>(unknowns_.first() + static_cast<std::int64_t>(i) + 1);
    record[1] = unknowns_.held()[i];
    record[2] = mass[i];
  });
  members_.clear();
  touches_.clear();
  std::vector<std::size_t> number;
  for (const Meeting& meeting : meetings) {
    number.clear();
    for (const Surface& surface : meeting.surfaces) number.push_back(add_member(surface, meeting.place));
    for (std::size_t a = 0; a < number.size(); ++a) {
      for (std::size_t b = a + 1; b < number.size(); ++b) {
        if (number[a] == no_own || number[b] == no_own) continue;
        // A rigid body comes first.
        const bool turned = members_[number[b]].rigid >= 0;
        const std::size_t first = turned ? b : a, second = turned ? a : b;
        Vec3<double> normal;
        if (touch(meeting.surfaces[first], meeting.surfaces[second], normal))
          add_touch(number[first], number[second], meeting.place, normal,
                    coefficient(meeting.surfaces[first], meeting.surfaces[second]));
      }
    }
  }
}

/// Whether two components touch, and their normal. The first may be rigid.
bool ImplicitContact::touch(const Surface& first, const Surface& second, Vec3<double>& normal) const {
  const GridGeometry& g = model_.grid->geometry();
  if (rigid(second.component) >= 0) return false;
  if (const int number = rigid(first.component); number >= 0) {
    if (at_faces_[static_cast<std::size_t>(number)]) return false;
    // Of a body's volume around a node over that of a cell: at its corners it is an eighth, at its faces a
    // half; beyond them it is less.
    constexpr double least_volume = 0.1;
    if (first.volume < least_volume * g.cell_volume()) return false;
    // The steeper one is that of a face. At an edge of the body, and inside it, where wide shape functions of
    // the material still reach, that is the material's; at an edge of the material the body's.
    // Where wide shape functions reach beyond the middle of the body, its gradient is that of its other side.
    const Vec3<double> body = first.gradient, material = -1.0 * second.gradient;
    const bool is_beyond = cosine(body, material) < -0.9;
    const Vec3<double> surface = is_beyond ? material : of_the_steeper(body, material, g.cell);
    const double length = std::sqrt(dot(surface, surface));
    if (length > 0) normal = (1 / length) * surface;
    return length > 0;
  }
  // Less is that of an inside where particles are not evenly spaced. Where hardly any of the other one is,
  // its side would have that in common.
  constexpr double uneven = 0.1;
  const auto of_surface = [&](const Surface& s) {
    Vec3<double> gradient = s.gradient;
    for (int a = 0; a < 3; ++a)
      if (std::abs(g.cell[a] * gradient[a]) < uneven * s.volume) gradient[a] = 0;
    return gradient;
  };
  const double weight[2] = {weight_[static_cast<std::size_t>(first.component)],
                            weight_[static_cast<std::size_t>(second.component)]};
  Vec3<double> along = first.gradient;
  if (weight[1] > weight[0]) along = -1.0 * second.gradient;
  const Surface& decides = weight[1] > weight[0] ? second : first;
  if (weight[1] == weight[0] || slope_of(decides.gradient, decides.volume, g.cell) < least_slope)
    along = common(of_surface(first), -1.0 * of_surface(second));
  // Of two that have no direction in common, one has the node inside, as the middle of a plate of two cells
  // or where wide functions of the other still reach: the other's face decides. What is opposite in them is
  // that of sides that both have. Where a face of both is left, it is the side of one and the front of the
  // other, which do not press on each other there.
  if (along == Vec3<double>{}) {
    constexpr double face = 0.5;  // least change of the volume over a cell, over itself
    Vec3<double> of_first = (1 / first.volume) * first.gradient,
                 of_second = (-1 / second.volume) * second.gradient;
    for (int a = 0; a < 3; ++a) {
      if (of_first[a] * of_second[a] >= 0) continue;
      const double sum = of_first[a] + of_second[a];
      const bool is_of_first = std::abs(of_first[a]) > std::abs(of_second[a]);
      of_first[a] = is_of_first ? sum : 0;
      of_second[a] = is_of_first ? 0 : sum;
    }
    if (std::min(steepness(of_first, g.cell), steepness(of_second, g.cell)) > face * face) return false;
    along = of_the_steeper(of_first, of_second, g.cell);
  }
  const double length = std::sqrt(dot(along, along));
  if (!(length > 0)) return false;
  normal = (1 / length) * along;
  const auto slope = [&](const Surface& s) {
    double sum = 0;
    for (int a = 0; a < 3; ++a) sum += g.cell[a] * s.gradient[a] * normal[a];
    return std::abs(sum);
  };
  return first.volume + second.volume >= least_cover * std::max(slope(first), slope(second));
}

/// Of friction between two components at a node. That of a rough rigid body, the first, acts inside it alone
/// (core/contact/contact_meetings.cpp): where the other one does not fill more of the node's cell. At a node
/// of the body's edge it does.
double ImplicitContact::coefficient(const Surface& first, const Surface& second) const {
  constexpr double uneven = 0.1;  // strains change the volume at a face that is at a node
  const Friction& of_pair = friction(first.component, second.component);
  const bool is_above = first.volume < (1 - uneven) * second.volume;
  return of_pair.rough && rigid(first.component) >= 0 && is_above ? 0.0 : of_pair.coefficient;
}

void ImplicitContact::add_touch(std::size_t first, std::size_t second, const Vec3<double>& place,
                                const Vec3<double>& normal, double coefficient) {
  const Member &a = members_[first], &b = members_[second];
  if (a.held == 7 && b.held == 7) return;
  const double k_a = stiffness_[static_cast<std::size_t>(a.component)],
               k_b = stiffness_[static_cast<std::size_t>(b.component)];
  Touch touch{first, second, place, {}};
  touch.counts = (a.number >= 0 ? a.own : b.own) != no_own;
  ContactSpring& spring = touch.spring;
  spring.normal = normal;
  spring.k = rigidity * std::max(k_a, k_b);
  spring.cell_stiffness = k_a > 0 && k_b > 0 ? k_a * k_b / (k_a + k_b) : std::max(k_a, k_b);
  spring.coefficient = coefficient;
  spring.sticks = coefficient > 0;
  const auto last = last_.find(key_of(touch));
  if (coefficient > 0 && last != last_.end()) std::tie(spring.sticks, spring.friction) = last->second;
  touches_.push_back(touch);
}

void ImplicitContact::take_displacements() {
  for (Member& member : members_)
    if (member.number >= 0) member.displacement = vector_of(unknowns_.shared(member.at));
}

void ImplicitContact::add_tangent(double factor, bool values, BlockMatrix& matrix) const {
  for (const Touch& touch : touches_) {
    if (!touch.counts) continue;
    const Member* const sides[2] = {&members_[touch.first], &members_[touch.second]};
    const Mat3<double> m = factor * response(touch).stiffness;
    const double k[9] = {m.xx, m.xy, m.xz, m.yx, m.yy, m.yz, m.zx, m.zy, m.zz};
    std::array<std::int64_t, 2> numbers;
    std::array<const Member*, 2> of;
    std::size_t n = 0;
    for (const Member* side : sides)
      if (side->number >= 0) of[n] = side, numbers[n++] = side->number;
    std::array<double, 36> sum{};
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t q = 0; q < n; ++q)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            if (of[p]->moves(i) && of[q]->moves(j))
              sum[3 * n * (3 * p + static_cast<std::size_t>(i)) + 3 * q + static_cast<std::size_t>(j)] =
                  (p == q ? 1 : -1) * k[3 * i + j];
    matrix.add(std::span(numbers).first(n), values ? sum.data() : nullptr);
  }
}

void ImplicitContact::find_friction(double relaxation, ContactSpring::Changes& changes) {
  next_ = touches_;
  for (Touch& touch : next_) touch.spring.find_friction(relative(touch), relaxation, touch.counts, changes);
}

void ImplicitContact::keep_friction() {
  last_.clear();
  for (const Touch& touch : touches_)
    if (touch.spring.coefficient > 0) last_[key_of(touch)] = {touch.spring.sticks, touch.spring.friction};
}

/// Nodes that press go on together, those that stick in all directions. The impulses follow one after the
/// other, in the same order on all ranks.
void ImplicitContact::find_stops(std::span<const double> velocity_at_end, double least_mass) {
  unknowns_.share([&](std::size_t i, double* record) {
    for (std::size_t a = 0; a < 3; ++a) record[a] = velocity_at_end[3 * i + a];
  });
  for (Member& member : members_)
    if (member.number >= 0) member.velocity = vector_of(unknowns_.shared(member.at));
  stops_.assign(touches_.size(), {});
  for (std::size_t t = 0; t < touches_.size(); ++t) {
    const Touch& touch = touches_[t];
    Member &a = members_[touch.first], &b = members_[touch.second];
    if (!(a.mass > least_mass && b.mass > least_mass && response(touch).pressure > 0)) continue;
    const auto per_mass = [](const Member& m, int axis) { return m.moves(axis) ? 1 / m.mass : 0.0; };
    const Vec3<double> before = b.velocity - a.velocity;
    Vec3<double> missing = (1 / dt_) * relative(touch) - before;
    for (int i = 0; i < 3; ++i)
      if (!a.moves(i) && !b.moves(i)) missing[i] = 0;
    if (!touch.spring.sticks) missing = dot(missing, touch.spring.normal) * touch.spring.normal;
    Stop& stop = stops_[t];
    for (int i = 0; i < 3; ++i) {
      const double both = per_mass(a, i) + per_mass(b, i);
      stop.impulse[i] = both > 0 ? missing[i] / both : 0;
      stop.on_first[i] = -per_mass(a, i) * stop.impulse[i];
      stop.on_second[i] = per_mass(b, i) * stop.impulse[i];
    }
    a.velocity = a.velocity + stop.on_first;
    b.velocity = b.velocity + stop.on_second;
    stop.gained = dot(stop.impulse, before + 0.5 * (stop.on_second - stop.on_first));
  }
}

void ImplicitContact::find_start(std::span<const Vec3<double>> force_of_own) {
  std::vector<int> bodies(members_.size());  // that act on a node
  for (const Touch& touch : touches_) {
    if (response(touch).force == Vec3<double>{}) continue;
    ++bodies[touch.first], ++bodies[touch.second];
  }
  start_.assign(touches_.size(), {});
  for (std::size_t t = 0; t < touches_.size(); ++t) {
    const Touch& touch = touches_[t];
    const bool rigid = members_[touch.first].number < 0;
    const std::size_t side = rigid ? touch.second : touch.first;
    const Member& member = members_[side];
    if (member.own == no_own || bodies[side] == 0) continue;
    for (int a = 0; a < 3; ++a)
      if (member.moves(a)) start_[t][a] = (rigid ? -1.0 : 1.0) * force_of_own[member.own][a] / bodies[side];
  }
}

void ImplicitContact::add_face(std::int32_t rigid, std::int32_t deformable, const Vec3<double>& place,
                               const Vec3<double>& impulse, double given, double heat, StepStatistics& to) {
  to.contact.pairs.resize(pairs_.size());
  const auto [first, second] = std::minmax({rigid, deformable});
  to.contact.add(pairs_.number(first, second), second == deformable ? impulse : -1.0 * impulse, heat);
  const int number = rigid_->of_component(rigid);
  impulses_[static_cast<std::size_t>(number)].add(-1.0 * impulse, place - rigid_->state(number).centre,
                                                  -given);
}

void ImplicitContact::end_step(StepStatistics& to) {
  to.contact.pairs.resize(pairs_.size());
  for (std::size_t t = 0; t < touches_.size(); ++t) {
    const Touch& touch = touches_[t];
    if (!touch.counts) continue;
    const Member &a = members_[touch.first], &b = members_[touch.second];
    const Vec3<double> d = relative(touch), force = response(touch).force;
    const Vec3<double> mean = start_.empty() ? force : 0.5 * (force + start_[t]);
    const Stop stop = stops_.empty() ? Stop{} : stops_[t];
    const Vec3<double> impulse = dt_ * force + stop.impulse;  // on the second
    if (impulse == Vec3<double>{}) continue;
    to.contact.dissipated.add(-dot(mean, d));
    to.contact.dissipated.add(-stop.gained);
    const auto [first, second] = std::minmax({a.component, b.component});
    to.contact.add(pairs_.number(first, second), second == b.component ? impulse : -1.0 * impulse,
                   -dot(mean, across(d, touch.spring.normal)));
    if (a.rigid < 0) continue;
    const Vec3<double> way = a.displacement;
    impulses_[static_cast<std::size_t>(a.rigid)].add(-1.0 * impulse,
                                                     touch.place - rigid_->state(a.rigid).centre,
                                                     -dot(mean, way) - dot(stop.impulse, way) / dt_);
  }
  start_.clear();
  stops_.clear();
  if (rigid_ == nullptr) return;
  rigid_->end_step(impulses_, to.work, to.contact);
  rigid_->set_velocities();
}

std::unique_ptr<ImplicitContact> make_implicit_contact(Model& model, RigidBodies* rigid,
                                                       NodeUnknowns& unknowns) {
  std::set<int> components;
  for (const Body& body : model.bodies) components.insert(body.component);
  if (!model.scene->contact.enable || components.size() < 2) return nullptr;
  return std::make_unique<ImplicitContact>(model, rigid, unknowns);
}

}  // namespace mpm::core
