#include "core/implicit/body_faces.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "core/communication/gather_records.hpp"

namespace mpm::core {

namespace {

/// Along an axis. Particles of SGMP do not feel displacements that alternate from node to node.
int nodes_per_patch(ShapeFunction shape) { return shape == ShapeFunction::sgmp ? 2 : 1; }

}  // namespace

std::vector<FacePoint> acting_faces(const Model& model, Reductions& ranks) {
  std::vector<int> bodies;
  const auto& input = model.scene->solution.implicit;
  const std::vector<const BodyInput*> inputs = active_bodies(*model.scene);
  if (!input || !input->quasistatic()) return {};
  const Loads loads(model);
  for (std::size_t b = 0; b < std::min(model.bodies.size(), inputs.size()); ++b) {
    const BodyInput& of = *inputs[b];
    const bool turns =
        of.prescribed_acceleration && of.prescribed_acceleration->angular_amplitude != Vec3<double>{};
    const bool driven = of.prescribed_velocity || of.constrain_rigid_position;
    const bool varies = !loads.motion(static_cast<int>(b)).velocity.terms.empty();
    if (model.bodies[b].model->rigid() && driven && !turns && !varies) bodies.push_back(static_cast<int>(b));
  }
  if (bodies.empty()) return {};
  return find_face_points(model, bodies, ranks);
}

std::vector<int> bodies_of(std::span<const FacePoint> points) {
  std::vector<int> bodies;
  for (const FacePoint& point : points)
    if (bodies.empty() || bodies.back() != point.body) bodies.push_back(point.body);
  return bodies;
}

BodyFaces::BodyFaces(Model& model, Reductions& ranks, const BrickFields& fields, NodeUnknowns& unknowns,
                     std::vector<FacePoint> points, ImplicitContact* contact)
    : model_(model),
      ranks_(ranks),
      fields_(fields),
      unknowns_(unknowns),
      contact_(contact),
      points_(std::move(points)),
      material_(model, fields, unknowns),
      patches_(model, ranks, fields, unknowns),
      first_(model.bodies.size()),
      moved_(model.bodies.size()),
      way_(model.bodies.size()),
      reaction_(model.bodies.size()),
      deforms_(model.scene->components.size(), false) {
  for (const Body& body : model.bodies)
    if (!body.model->rigid()) deforms_[static_cast<std::size_t>(body.component)] = true;
  if (contact == nullptr) cover_.emplace(model, ranks, points_);
  for (std::size_t p = points_.size(); p-- > 0;) first_[static_cast<std::size_t>(points_[p].body)] = p;
  take_kept();
}

/// Those that the model has from a restart file, of points that the bodies still have.
void BodyFaces::take_kept() {
  for (const int b : bodies_of(points_)) {
    const std::vector<double>& values = model_.bodies[static_cast<std::size_t>(b)].face_forces;
    const std::size_t first = first_[static_cast<std::size_t>(b)], all = points_.size();
    for (std::size_t at = 0; at + size_of_kept <= values.size(); at += size_of_kept) {
      Kept k;
      std::memcpy(&k, values.data() + at, sizeof k);
      k.number += static_cast<double>(first);
      const bool is_here = k.number >= static_cast<double>(first) && k.number < static_cast<double>(all);
      if (is_here && points_[static_cast<std::size_t>(k.number)].body == b) kept_.push_back(k);
    }
  }
  std::ranges::sort(kept_, {}, order);
}

void BodyFaces::begin_step(const Loads& loads, double dt) {
  dt_ = dt;
  for (const int b : bodies_of(points_)) {
    way_[static_cast<std::size_t>(b)] = dt * loads.motion(b).velocity.common;
    reaction_[static_cast<std::size_t>(b)] = loads.motion(b).reaction;
  }
}

Vec3<double> BodyFaces::place(std::size_t number) const {
  return points_[number].place + moved_[static_cast<std::size_t>(points_[number].body)];
}

void BodyFaces::find_patches(ImplicitPasses& passes) {
  passes.map_surface();
  unknowns_.exchange(mapped::implicit_surface);
  material_.take_surface();
  patches_.clear();
  const std::vector<bool> covered = cover_ ? cover_->find(moved_) : std::vector<bool>{};
  std::vector<FaceTouch> touches;
  for (std::size_t p = 0; p < points_.size(); ++p)
    if (!cover_ || covered[p]) find_touches(p, touches);
  material_.fit(touches, points_);
  for (const FaceTouch& touch : touches) patches_.add(key_of(touch), touch, sums_of(touch));
  patches_.complete();
  for (FacePatch& patch : patches_.all()) prepare(patch);
}

/// Adds the touches of a point with all components.
void BodyFaces::find_touches(std::size_t number, std::vector<FaceTouch>& found) const {
  const BrickGrid& grid = *model_.grid;
  const GridGeometry& g = grid.geometry();
  const FacePoint& point = points_[number];
  const Vec3<double> x = place(number);
  if (!g.contains(x)) return;
  constexpr double near = 1e-6;  // of a cell: a face that lies on one of the grid's
  const int axis = axis_of(point.normal);
  for (int a = 0; a < 3; ++a) {
    const double s = GridGeometry::scaled(x[a], g.origin[a], g.inverse_cell[a]);
    const auto last = static_cast<double>(g.cells[static_cast<std::size_t>(a)]);
    if ((point.normal[a] < -0.5 && s < near) || (point.normal[a] > 0.5 && s > last - near)) return;
  }
  const BrickCoord home = g.brick_at(x);
  BrickCoord next = home;  // towards the other body
  (axis == 0 ? next.x : axis == 1 ? next.y : next.z) += point.normal[axis] > 0 ? 1 : -1;
  const Slot at_home = grid.find(home);
  const auto has = [&](Slot s, std::int32_t component) {
    return s != no_slot && (component == all_components || grid.field_of(s, component) >= 0);
  };
  for (const Slot s : {at_home, grid.find(next)}) {
    if (s == no_slot || s >= grid.owned()) continue;
    for (const BrickField& field : fields_.of(s)) {
      if (field.component >= 0 && !deforms_[static_cast<std::size_t>(field.component)]) continue;
      if (s != at_home && has(at_home, field.component)) continue;
      const Kept* const last = kept(number, field.component);
      const bool is_known = last != nullptr && (contact_ == nullptr || last->pressure > 0);
      if (const std::optional<FaceTouch> touch = material_.touch(field, point, x, is_known)) {
        found.push_back(*touch);
        found.back().point = number;
      }
    }
  }
}

/// Of the patch of a point. What is tied has patches; in contact, which bears no tension, a point is one, and
/// material presses as far as it reaches, and no farther.
FacePatch::Key BodyFaces::key_of(const FaceTouch& touch) const {
  const GridGeometry& g = model_.grid->geometry();
  const FacePoint& point = points_[touch.point];
  const Vec3<double> x = touch.place;
  const int normal = axis_of(point.normal);
  FacePatch::Key key{point.body, component_of(touch), FacePatch::many_points};
  if (contact_ != nullptr) {
    key[2] = static_cast<std::int64_t>(touch.point);
    return key;
  }
  key[3] = 2 * normal + (point.normal[normal] > 0 ? 1 : 0);
  const int nodes = nodes_per_patch(model_.scene->grid.shape);
  for (int a = 0; a < 3; ++a)
    key[static_cast<std::size_t>(4 + a)] =
        a == normal ? g.cell_index(x[a], a) : nearest_node(g, x, a) / nodes;
  return key;
}

PatchSums BodyFaces::sums_of(const FaceTouch& touch) const {
  const FacePoint& point = points_[touch.point];
  const Kept* const last = kept(touch.point, component_of(touch));
  const double area = point.area, h = model_.grid->geometry().smallest_cell();
  PatchSums sums;
  sums.area = area;
  sums.stiffness = touch.modulus * area / h;
  sums.place = area * touch.place;
  sums.normal = area * point.normal;
  if (last == nullptr) return sums;
  sums.known = area;
  sums.stuck = last->sticks * area;
  sums.pressure = last->pressure;
  for (int a = 0; a < 3; ++a) {
    sums.force[a] = last->pressure * point.normal[a] - last->friction[a];
    sums.gap[a] = area * last->gap[a];
  }
  return sums;
}

/// Its spring, from where the last step has left it.
void BodyFaces::prepare(FacePatch& patch) const {
  PatchSums& sums = patch.sums;
  ContactSpring& spring = patch.spring;
  for (int a = 0; a < 3; ++a)
    if ((patch.on_walls >> a & 1) != 0) sums.normal[a] = sums.force[a] = 0;
  const double length = std::sqrt(dot(sums.normal, sums.normal));
  if (length > 0) spring.normal = (1 / length) * sums.normal;
  spring.cell_stiffness = sums.stiffness;
  spring.k = rigidity * sums.stiffness;
  spring.tied = contact_ == nullptr;
  if (contact_ != nullptr)
    spring.coefficient = contact_->coefficient(
        model_.bodies[static_cast<std::size_t>(patch.body())].component, patch.component());
  spring.sticks = spring.coefficient > 0 && !(sums.stuck < 0.5 * sums.known);
  spring.first = sums.pressure;
  spring.friction = sums.pressure * spring.normal - sums.force;
  if (sums.known > 0) spring.gap = (1 / sums.known) * sums.gap;
}

const BodyFaces::Kept* BodyFaces::kept(std::size_t number, std::int32_t component) const {
  const std::pair<double, double> key{static_cast<double>(number), static_cast<double>(component)};
  const auto at = std::ranges::lower_bound(kept_, key, {}, order);
  return at != kept_.end() && order(*at) == key ? &*at : nullptr;
}

/// Points in contact that have parted from a body, and no longer touch it, know how far they are from where
/// it was.
void BodyFaces::keep_parted(std::span<const Kept> before) {
  if (contact_ == nullptr) return;
  std::vector<Kept> parted;
  for (Kept k : before) {
    const auto number = static_cast<std::size_t>(k.number);
    if (k.pressure > 0 || kept(number, static_cast<std::int32_t>(k.component)) != nullptr) continue;
    const FacePoint& point = points_[number];
    const Vec3<double> gap =
        Vec3<double>{k.gap[0], k.gap[1], k.gap[2]} - way_[static_cast<std::size_t>(point.body)];
    const double open = dot(gap, point.normal);
    if (!(open > 0)) continue;
    for (int a = 0; a < 3; ++a) k.gap[a] = open * point.normal[a];
    parted.push_back(k);
  }
  kept_.insert(kept_.end(), parted.begin(), parted.end());
  std::ranges::sort(kept_, {}, order);
}

std::vector<Vec3<double>> BodyFaces::relative(const AlignedDoubles& displacements) const {
  std::vector<Vec3<double>> d = patches_.displacements(displacements);
  for (std::size_t p = 0; p < d.size(); ++p) {
    const FacePatch& patch = patches_.all()[p];
    d[p] = d[p] - way_of(patch);
    for (int a = 0; a < 3; ++a)
      if ((patch.on_walls >> a & 1) != 0) d[p][a] = 0;
  }
  return d;
}

void BodyFaces::add_forces(const AlignedDoubles& displacements) {
  const std::vector<Vec3<double>> d = relative(displacements);
  for (std::size_t p = 0; p < d.size(); ++p) {
    const FacePatch& patch = patches_.all()[p];
    patches_.add_force(patch, patch.spring.response(d[p]).force);
  }
}

void BodyFaces::add_start_forces() {
  for (const FacePatch& patch : patches_.all()) patches_.add_force(patch, patch.sums.force);
}

void BodyFaces::add_tangent(const AlignedDoubles* displacements, BlockMatrix& matrix) const {
  const std::vector<Vec3<double>> d =
      displacements != nullptr ? relative(*displacements) : std::vector<Vec3<double>>{};
  std::vector<double> e, sum;
  for (std::size_t p = 0; p < patches_.all().size(); ++p) {
    const FacePatch& patch = patches_.all()[p];
    if (!patch.counts) continue;
    if (displacements == nullptr) {
      matrix.add(patch.unknowns, nullptr);
      continue;
    }
    sum.assign(9 * patch.unknowns.size() * patch.unknowns.size(), 0.0);
    patch.spring.for_each_direction(d[p], [&](const Vec3<double>& along) {
      e.clear();
      for (const Vec3<double>& factor : patch.factors)
        for (int a = 0; a < 3; ++a) e.push_back(factor[a] * along[a]);
      for (std::size_t r = 0; r < e.size(); ++r)
        for (std::size_t c = 0; c < e.size(); ++c) sum[r * e.size() + c] += patch.spring.k * e[r] * e[c];
    });
    matrix.add(patch.unknowns, sum.data());
  }
}

double BodyFaces::violation(const AlignedDoubles& displacements) const {
  const std::vector<Vec3<double>> d = relative(displacements);
  double largest = 0;
  for (std::size_t p = 0; p < d.size(); ++p) {
    const Vec3<double> held = patches_.all()[p].spring.held(d[p]);
    for (int a = 0; a < 3; ++a) largest = std::max(largest, std::abs(held[a]));
  }
  return ranks_.largest(largest) / model_.grid->geometry().smallest_cell();
}

void BodyFaces::find_friction(const AlignedDoubles& displacements, double relaxation,
                              ContactSpring::Changes& changes) {
  const std::vector<Vec3<double>> d = relative(displacements);
  next_.clear();
  for (std::size_t p = 0; p < d.size(); ++p) {
    const FacePatch& patch = patches_.all()[p];
    next_.push_back(patch.spring);
    next_.back().find_friction(d[p], relaxation, patch.counts, changes);
  }
}

void BodyFaces::take_friction() {
  for (std::size_t p = 0; p < next_.size(); ++p) patches_.all()[p].spring = next_[p];
}

void BodyFaces::take_forces(const AlignedDoubles& displacements) {
  const std::vector<Vec3<double>> d = relative(displacements);
  for (std::size_t p = 0; p < d.size(); ++p) patches_.all()[p].spring.take_force(d[p]);
}

void BodyFaces::end_step(const AlignedDoubles& displacements, StepStatistics& to) {
  if (contact_ == nullptr) to.reactions.resize(model_.reactions.size());
  const std::vector<Vec3<double>> relative_to = relative(displacements);
  std::vector<Kept> mine;
  for (std::size_t p = 0; p < relative_to.size(); ++p) {
    const FacePatch& patch = patches_.all()[p];
    const Vec3<double> d = relative_to[p], way = way_of(patch), force = patch.spring.response(d).force,
                       mean = 0.5 * (patch.sums.force + force);
    keep(patch, d, mine);
    if (!patch.counts) continue;
    if (contact_ == nullptr) {
      to.work.add(dot(mean, d + way));
      ReactionSums& sums = to.reactions[reaction_[static_cast<std::size_t>(patch.body())]];
      sums.add(ReactionSums::impulse, dt_ * force);
      sums.add(ReactionSums::moment, cross(patch.place(), dt_ * force));
      continue;
    }
    to.contact.dissipated.add(-dot(mean, d));
    contact_->add_face(model_.bodies[static_cast<std::size_t>(patch.body())].component, patch.component(),
                       patch.place(), dt_ * force, dot(mean, way), -dot(mean, across(d, patch.spring.normal)),
                       to);
  }
  const std::vector<Kept> before = std::exchange(kept_, gather_records(std::span<const Kept>(mine), ranks_));
  std::ranges::sort(kept_, {}, order);
  keep_parted(before);
  give_to_model();
  for (std::size_t b = 0; b < moved_.size(); ++b) moved_[b] = moved_[b] + way_[b];
}

/// What this rank's points of a patch keep: each its part of the force, and what is left of the displacement
/// where the spring holds; where the two have parted, how far.
void BodyFaces::keep(const FacePatch& patch, const Vec3<double>& d, std::vector<Kept>& to) const {
  const ContactSpring& spring = patch.spring;
  const ContactSpring::Response found = spring.response(d);
  Vec3<double> left = spring.held(d);
  if (!spring.tied && found.pressure == 0)
    left = std::max(0.0, dot(d + spring.gap, spring.normal)) * spring.normal;
  for (const std::size_t number : patch.points) {
    const double part = points_[number].area / patch.sums.area;
    const Vec3<double> t = part * (found.pressure * points_[number].normal - found.force);
    to.push_back({static_cast<double>(number),
                  static_cast<double>(patch.component()),
                  spring.sticks ? 1.0 : 0.0,
                  part * found.pressure,
                  {t.x, t.y, t.z},
                  {left.x, left.y, left.z}});
  }
}

/// For restart files.
void BodyFaces::give_to_model() const {
  for (const int b : bodies_of(points_)) model_.bodies[static_cast<std::size_t>(b)].face_forces.clear();
  for (Kept k : kept_) {
    const auto body = static_cast<std::size_t>(points_[static_cast<std::size_t>(k.number)].body);
    k.number -= static_cast<double>(first_[body]);
    std::vector<double>& of_body = model_.bodies[body].face_forces;
    of_body.resize(of_body.size() + size_of_kept);
    std::memcpy(of_body.data() + of_body.size() - size_of_kept, &k, sizeof k);
  }
}

}  // namespace mpm::core
