#include "core/implicit/body_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <utility>

#include "core/shape/bspline.hpp"

namespace mpm::core {

namespace {

/// Nodes per axis of the weights of a point: those of the functions whose gradients particles feel.
int nodes_per_axis(ShapeFunction shape) {
  switch (shape) {
    case ShapeFunction::cubic_bspline: return 4;
    case ShapeFunction::quadratic_bspline:
    case ShapeFunction::sgmp: return 3;
    default: return 2;
  }
}

/// Weights of `n` nodes along an axis at x, in cells from the brick's first node. The first node's number.
int weights_along(int n, double x, double* w) {
  double slopes[4];
  if (n == 3) {
    const double node = std::floor(x + 0.5);
    QuadraticAlong::evaluate(x + 0.5 - node, w, slopes);
    return static_cast<int>(node) - 1;
  }
  const double cell = std::floor(x);
  if (n == 4) {
    CubicAlong::evaluate(x - cell, w, slopes);
    return static_cast<int>(cell) - 1;
  }
  w[1] = x - cell;
  w[0] = 1 - w[1];
  return static_cast<int>(cell);
}

/// The axis nearest to a direction.
int axis_of(const Vec3<double>& direction) {
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (std::abs(direction[a]) > std::abs(direction[axis])) axis = a;
  return axis;
}

/// Least volume around a point over its change along the normal over a cell: with splines that of a face at a
/// distance of about 0.3 cells. Where the face is at the point it is 0.83, 0.89 and 1.03 (medians) with
/// functions of two, three and four nodes along an axis, with two between 0.5 and 1.1.
double least_volume(int nodes_per_axis) {
  return nodes_per_axis == 2 ? 0.3 : nodes_per_axis == 3 ? 0.65 : 0.8;
}
/// The same of a point that has pressed or been tied, over that.
constexpr double of_known = 0.5;

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
      faces_(std::move(points)),
      first_(model.bodies.size()),
      moved_(model.bodies.size()),
      way_(model.bodies.size()),
      reaction_(model.bodies.size()),
      deforms_(model.scene->components.size(), false),
      layers_(nodes_per_axis(model.scene->grid.shape)) {
  for (const Body& body : model.bodies)
    if (!body.model->rigid()) deforms_[static_cast<std::size_t>(body.component)] = true;
  for (std::size_t p = faces_.size(); p-- > 0;) first_[static_cast<std::size_t>(faces_[p].body)] = p;
  take_kept();
}

/// Those that the model has from a restart file, of points that the bodies still have.
void BodyFaces::take_kept() {
  for (const int b : bodies_of(faces_)) {
    const std::vector<double>& values = model_.bodies[static_cast<std::size_t>(b)].face_forces;
    const std::size_t first = first_[static_cast<std::size_t>(b)], all = faces_.size();
    for (std::size_t at = 0; at + size_of_kept <= values.size(); at += size_of_kept) {
      Kept k;
      std::memcpy(&k, values.data() + at, sizeof k);
      k.number += static_cast<double>(first);
      const bool is_here = k.number >= static_cast<double>(first) && k.number < static_cast<double>(all);
      if (is_here && faces_[static_cast<std::size_t>(k.number)].body == b) kept_.push_back(k);
    }
  }
  std::ranges::sort(kept_, {}, key_of);
}

void BodyFaces::begin_step(const Loads& loads, double dt) {
  dt_ = dt;
  for (const int b : bodies_of(faces_)) {
    way_[static_cast<std::size_t>(b)] = dt * loads.motion(b).velocity.common;
    reaction_[static_cast<std::size_t>(b)] = loads.motion(b).reaction;
  }
}

Vec3<double> BodyFaces::place(std::size_t number) const {
  return faces_[number].place + moved_[static_cast<std::size_t>(faces_[number].body)];
}

void BodyFaces::take_sums(std::vector<double>& to) const {
  const auto doubles = static_cast<std::size_t>(node_doubles * unknowns_.nodes());
  to.resize(doubles * fields_.count());
  for (const BrickField& field : fields_.all()) unknowns_.sums(field, to.data() + doubles * field.index);
}

void BodyFaces::find_points(ImplicitPasses& passes) {
  passes.map_surface();
  unknowns_.exchange(mapped::implicit_surface);
  take_sums(sums_);
  points_.clear();
  for (std::size_t p = 0; p < faces_.size(); ++p) add_points_of(p);
  find_patches();
}

/// Those of one body, field, cell and axis of the normal.
void BodyFaces::find_patches() {
  const GridGeometry& g = model_.grid->geometry();
  std::map<std::array<std::int64_t, 6>, std::size_t> number;
  std::size_t last = 0;
  for (Point& point : points_) {
    const FacePoint& face = faces_[point.number];
    const Vec3<double> x = place(point.number);
    std::array<std::int64_t, 6> key{face.body, static_cast<std::int64_t>(point.field), axis_of(face.normal)};
    for (int a = 0; a < 3; ++a) key[static_cast<std::size_t>(3 + a)] = g.cell_index(x[a], a);
    point.patch = number.try_emplace(key, number.size()).first->second;
    last = std::max(last, point.patch);
  }
  patches_ = points_.empty() ? 0 : last + 1;
}

void BodyFaces::add_points_of(std::size_t number) {
  const BrickGrid& grid = *model_.grid;
  const GridGeometry& g = grid.geometry();
  const FacePoint& face = faces_[number];
  const Vec3<double> x = place(number);
  if (!g.contains(x)) return;
  constexpr double near = 1e-6;  // of a cell: a face that lies on one of the grid's
  const int axis = axis_of(face.normal);
  for (int a = 0; a < 3; ++a) {
    const double s = GridGeometry::scaled(x[a], g.origin[a], g.inverse_cell[a]);
    const auto last = static_cast<double>(g.cells[static_cast<std::size_t>(a)]);
    if ((face.normal[a] < -0.5 && s < near) || (face.normal[a] > 0.5 && s > last - near)) return;
  }
  const BrickCoord home = g.brick_at(x);
  BrickCoord next = home;  // towards the other body
  (axis == 0 ? next.x : axis == 1 ? next.y : next.z) += face.normal[axis] > 0 ? 1 : -1;
  const Slot at_home = grid.find(home);
  const auto has = [&](Slot s, std::int32_t component) {
    return s != no_slot && (component == all_components || grid.field_of(s, component) >= 0);
  };
  for (const Slot s : {at_home, grid.find(next)}) {
    if (s == no_slot || s >= grid.owned()) continue;
    for (const BrickField& field : fields_.of(s)) {
      if (field.component >= 0 && !deforms_[static_cast<std::size_t>(field.component)]) continue;
      if (s != at_home && has(at_home, field.component)) continue;
      Point point;
      if (touch(field, number, x, point)) points_.push_back(std::move(point));
    }
  }
}

/// Whether the material of a field touches a point, and its weights.
bool BodyFaces::touch(const BrickField& field, std::size_t number, const Vec3<double>& place,
                      Point& point) const {
  const BrickGrid& grid = *model_.grid;
  const GridGeometry& g = grid.geometry();
  const NodeBlockShape shape = grid.shape();
  const BrickCoord brick = grid.brick(field.slot).coord;
  const std::int32_t corner[3] = {brick_cells * brick.x, brick_cells * brick.y, brick_cells * brick.z};
  double w[3][4];
  int first[3];
  for (int a = 0; a < 3; ++a)
    first[a] = weights_along(
        layers_, GridGeometry::scaled(place[a], g.origin[a], g.inverse_cell[a]) - corner[a], w[a]);
  const NodeUnknowns::Node* nodes = unknowns_.of(field);
  const std::size_t first_sum = static_cast<std::size_t>(node_doubles * shape.nodes()) * field.index;
  const double *sums = sums_.data() + first_sum, *moduli = moduli_.data() + first_sum;
  double stiff = 0, of_stiff = 0;           // sums of volumes times moduli, and of volumes
  double active = 0, volume = 0, room = 0;  // room: of cells around the nodes, inside the grid
  Vec3<double> gradient{};
  for (int k = 0; k < layers_; ++k)
    for (int j = 0; j < layers_; ++j)
      for (int i = 0; i < layers_; ++i) {
        const double weight = w[0][i] * w[1][j] * w[2][k];
        const int at[3] = {first[0] + i, first[1] + j, first[2] + k};
        if (weight == 0 ||
            std::ranges::any_of(at, [&](int n) { return n < shape.lowest() || n > shape.highest(); }))
          continue;
        const int node = shape.index(at[0], at[1], at[2]);
        if (nodes[node].number < 0) continue;
        active += weight;
        point.weights.push_back({node, weight});
        if (nodes[node].from != node) continue;
        const double* sum = sums + node_doubles * node;
        stiff += weight * moduli[node_doubles * node + node_field::modulus.first];
        of_stiff += weight * moduli[node_doubles * node + node_field::volume.first];
        double part = 1;
        for (int a = 0; a < 3; ++a) {
          // A wall continues what is behind it.
          const std::int64_t n = corner[a] + at[a];
          const bool on_wall = n == 0 || n == g.cells[static_cast<std::size_t>(a)];
          if (on_wall) part *= 0.5;
          if (!on_wall) gradient[a] += weight * sum[a];
        }
        room += weight * part * g.cell_volume();
        volume += weight * sum[node_field::mass.first];
      }
  constexpr double least_active = 0.25, least_cosine = 0.4, beside = 0.1;
  if (!(active > least_active && volume > beside * room)) return false;
  // The sums of V grad S point out of the other body, whose volume thus grows along the normal.
  const FacePoint& face = faces_[number];
  const double growth = -dot(gradient, face.normal), length = std::sqrt(dot(gradient, gradient));
  double cell_along = 0;
  for (int a = 0; a < 3; ++a) cell_along += std::abs(face.normal[a]) * g.cell[a];
  const Kept* const last = kept({static_cast<double>(number), static_cast<double>(field.component)});
  const bool is_known = last != nullptr && (contact_ == nullptr || last->pressure > 0);
  const double least = (is_known ? of_known : 1.0) * least_volume(layers_) * cell_along * growth;
  if (growth < least_cosine * length || volume < least) return false;
  for (auto& [node, weight] : point.weights) weight /= active;
  point.number = number;
  point.field = field.index;
  point.component = field.component;
  ContactSpring& spring = point.spring;
  const double h = g.smallest_cell(), cell = stiff / of_stiff * h;
  spring.normal = face.normal;
  spring.k = rigidity * cell * face.area / (h * h);
  spring.cell_stiffness = cell * face.area / (h * h);
  spring.tied = contact_ == nullptr;
  if (contact_ != nullptr)
    spring.coefficient =
        contact_->coefficient(model_.bodies[static_cast<std::size_t>(face.body)].component, field.component);
  spring.sticks = spring.coefficient > 0;
  if (last != nullptr) {
    spring.first = last->pressure;
    spring.friction = {last->friction[0], last->friction[1], last->friction[2]};
    spring.gap = point.before = {last->gap[0], last->gap[1], last->gap[2]};
    if (spring.coefficient > 0) spring.sticks = last->sticks != 0;
  }
  point.start = spring.first * spring.normal - spring.friction;
  return true;
}

const BodyFaces::Kept* BodyFaces::kept(const std::pair<double, double>& key) const {
  const auto at = std::ranges::lower_bound(kept_, key, {}, key_of);
  return at != kept_.end() && key_of(*at) == key ? &*at : nullptr;
}

/// Points that have parted from a body, and no longer touch it, know how far they are from where it was.
void BodyFaces::keep_parted(std::span<const Kept> before) {
  std::vector<Kept> parted;
  for (Kept k : before) {
    if (k.pressure > 0 || kept(key_of(k)) != nullptr) continue;
    const FacePoint& face = faces_[static_cast<std::size_t>(k.number)];
    const Vec3<double> gap =
        Vec3<double>{k.gap[0], k.gap[1], k.gap[2]} - way_[static_cast<std::size_t>(face.body)];
    const double open = dot(gap, face.normal);
    if (!(open > 0)) continue;
    for (int a = 0; a < 3; ++a) k.gap[a] = open * face.normal[a];
    parted.push_back(k);
  }
  kept_.insert(kept_.end(), parted.begin(), parted.end());
  std::ranges::sort(kept_, {}, key_of);
}

Vec3<double> BodyFaces::relative(const Point& point, const AlignedDoubles& displacements) const {
  const double* records =
      displacements.data() + static_cast<std::size_t>(node_doubles * unknowns_.nodes()) * point.field;
  Vec3<double> u{};
  for (const auto& [node, weight] : point.weights)
    for (int a = 0; a < 3; ++a) u[a] += weight * records[node_doubles * node + a];
  return u - way_[static_cast<std::size_t>(faces_[point.number].body)];
}

void BodyFaces::add_forces(const AlignedDoubles& displacements) {
  for (const Point& point : points_)
    add_force(point, point.spring.response(relative(point, displacements)).force);
}

void BodyFaces::add_start_forces() {
  for (const Point& point : points_) add_force(point, point.start);
}

void BodyFaces::add_force(const Point& point, const Vec3<double>& force) {
  const BrickField& field = fields_.all()[point.field];
  const NodeUnknowns::Node* nodes = unknowns_.of(field);
  double* to = model_.grid->contributions(NodeArray::first, field.slot, field.number);
  for (const auto& [node, weight] : point.weights) {
    double* record = to + node_doubles * nodes[node].from;
    for (int a = 0; a < 3; ++a) {
      const double f = weight * force[a];
      record[node_field::force.first + a] += nodes[node].sign[a] * f;
      record[node_field::support.first] += std::abs(f);
    }
  }
}

void BodyFaces::add_tangent(const AlignedDoubles* displacements, BlockMatrix& matrix) const {
  std::vector<std::int64_t> numbers;
  std::vector<const NodeUnknowns::Node*> of;
  std::vector<Vec3<double>> factor;  // of the displacement of each in that of the point, by component
  std::vector<double> e, sum;
  for (const Point& point : points_) {
    const NodeUnknowns::Node* nodes = unknowns_.of(fields_.all()[point.field]);
    numbers.clear(), of.clear(), factor.clear();
    for (const auto& [node, weight] : point.weights) {
      const NodeUnknowns::Node& n = nodes[node];
      const auto known = std::ranges::find(numbers, n.number) - numbers.begin();
      if (known == std::ssize(numbers)) {
        numbers.push_back(n.number), of.push_back(&nodes[n.from]), factor.push_back({});
      }
      for (int a = 0; a < 3; ++a) factor[static_cast<std::size_t>(known)][a] += n.sign[a] * weight;
    }
    if (displacements == nullptr) {
      matrix.add(numbers, nullptr);
      continue;
    }
    sum.assign(9 * numbers.size() * numbers.size(), 0.0);
    point.spring.for_each_direction(relative(point, *displacements), [&](const Vec3<double>& along) {
      e.clear();
      for (std::size_t p = 0; p < numbers.size(); ++p)
        for (int a = 0; a < 3; ++a) e.push_back((of[p]->held >> a & 1) != 0 ? 0.0 : factor[p][a] * along[a]);
      for (std::size_t r = 0; r < e.size(); ++r)
        for (std::size_t c = 0; c < e.size(); ++c) sum[r * e.size() + c] += point.spring.k * e[r] * e[c];
    });
    matrix.add(numbers, sum.data());
  }
}

std::vector<Vec3<double>> BodyFaces::violations(const AlignedDoubles& displacements) const {
  std::vector<Vec3<double>> mean(patches_);
  std::vector<int> count(mean.size());
  for (const Point& point : points_) {
    const Vec3<double> d = relative(point, displacements), held = point.spring.held(d, d + point.before);
    if (held == Vec3<double>{}) continue;
    mean[point.patch] = mean[point.patch] + held;
    ++count[point.patch];
  }
  for (std::size_t p = 0; p < mean.size(); ++p)
    if (count[p] > 0) mean[p] = (1.0 / count[p]) * mean[p];
  return mean;
}

double BodyFaces::violation(const AlignedDoubles& displacements) const {
  double largest = 0;
  for (const Vec3<double>& of_patch : violations(displacements))
    for (int a = 0; a < 3; ++a) largest = std::max(largest, std::abs(of_patch[a]));
  return largest / model_.grid->geometry().smallest_cell();
}

void BodyFaces::find_friction(const AlignedDoubles& displacements, double relaxation,
                              ContactSpring::Changes& changes) {
  next_.clear();
  for (const Point& point : points_) {
    next_.push_back(point.spring);
    next_.back().find_friction(relative(point, displacements), relaxation, true, changes);
  }
}

void BodyFaces::take_friction() {
  for (std::size_t i = 0; i < points_.size(); ++i) points_[i].spring = next_[i];
}

void BodyFaces::take_forces(const AlignedDoubles& displacements) {
  const std::vector<Vec3<double>> left = violations(displacements);
  for (Point& point : points_) {
    const Vec3<double> d = relative(point, displacements);
    const Vec3<double> mean = point.spring.held(d, left[point.patch] - d), own = point.spring.gap;
    const Vec3<double> kept = own - point.spring.held(d, own);
    point.spring.take_force(d);
    point.spring.gap = mean + kept;
  }
}

/// The forces per area of patches.
std::vector<Vec3<double>> BodyFaces::tractions(const AlignedDoubles& displacements) const {
  std::vector<Vec3<double>> mean(patches_);
  std::vector<double> area(mean.size());
  for (const Point& point : points_) {
    mean[point.patch] = mean[point.patch] + point.spring.response(relative(point, displacements)).force;
    area[point.patch] += faces_[point.number].area;
  }
  for (std::size_t p = 0; p < mean.size(); ++p) mean[p] = (1 / area[p]) * mean[p];
  return mean;
}

void BodyFaces::end_step(const AlignedDoubles& displacements, StepStatistics& to) {
  if (contact_ == nullptr) to.reactions.resize(model_.reactions.size());
  const std::vector<Vec3<double>> violated = violations(displacements), traction = tractions(displacements);
  std::string bytes;
  for (const Point& point : points_) {
    const FacePoint& face = faces_[point.number];
    const Vec3<double> d = relative(point, displacements), way = way_[static_cast<std::size_t>(face.body)];
    const ContactSpring::Response found = point.spring.response(d);
    const Vec3<double> mean = 0.5 * (point.start + found.force);
    // Of what is tied the mean of the patch.
    const Vec3<double> force = point.spring.tied ? face.area * traction[point.patch] : found.force;
    const double pressure = point.spring.tied ? dot(force, face.normal) : found.pressure;
    const Vec3<double> t = pressure * face.normal - force;
    // Of what holds the mean; where the two have parted, how far.
    Vec3<double> left = point.spring.held(d, violated[point.patch]);
    if (!point.spring.tied && found.pressure == 0)
      left = std::max(0.0, dot(d + point.before, face.normal)) * face.normal;
    const Kept keep{static_cast<double>(point.number),
                    static_cast<double>(point.component),
                    point.spring.sticks ? 1.0 : 0.0,
                    pressure,
                    {t.x, t.y, t.z},
                    {left.x, left.y, left.z}};
    bytes.append(reinterpret_cast<const char*>(&keep), sizeof keep);
    if (contact_ == nullptr) {
      to.work.add(dot(mean, d + way));
      ReactionSums& sums = to.reactions[reaction_[static_cast<std::size_t>(face.body)]];
      sums.add(ReactionSums::impulse, dt_ * found.force);
      sums.add(ReactionSums::moment, cross(place(point.number), dt_ * found.force));
      continue;
    }
    const auto body = static_cast<std::size_t>(face.body);
    to.contact.dissipated.add(-dot(mean, d));
    contact_->add_face(model_.bodies[body].component, point.component, place(point.number), dt_ * found.force,
                       dot(mean, way), -dot(mean, across(d, face.normal)), to);
  }
  const std::vector<Kept> before = std::exchange(kept_, {});
  for (const std::string& of_rank : ranks_.gather(bytes)) {
    const std::size_t first = kept_.size();
    kept_.resize(first + of_rank.size() / sizeof(Kept));
    if (!of_rank.empty()) std::memcpy(kept_.data() + first, of_rank.data(), of_rank.size());
  }
  std::ranges::sort(kept_, {}, key_of);
  keep_parted(before);
  for (const int b : bodies_of(faces_)) model_.bodies[static_cast<std::size_t>(b)].face_forces.clear();
  for (const Kept& k : kept_) {
    std::vector<double>& of_body =
        model_.bodies[static_cast<std::size_t>(faces_[static_cast<std::size_t>(k.number)].body)].face_forces;
    const auto* values = reinterpret_cast<const double*>(&k);
    of_body.insert(of_body.end(), values, values + size_of_kept);
    of_body[of_body.size() - size_of_kept] -= static_cast<double>(
        first_[static_cast<std::size_t>(faces_[static_cast<std::size_t>(k.number)].body)]);
  }
  for (std::size_t b = 0; b < moved_.size(); ++b) moved_[b] = moved_[b] + way_[b];
}

}  // namespace mpm::core
