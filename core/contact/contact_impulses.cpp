// The impulses at the nodes where fields meet.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/contact/contact.hpp"

namespace mpm::core {

/// The fields at a node that have mass there, and their pairs that may touch.
struct Contact::Node {
  std::int64_t in_grid = 0;  ///< number
  Vec3<double> place{};
  std::vector<ContactField> fields;
  std::vector<int> rigid;    ///< numbers of the rigid bodies; -1: deformable
  std::vector<double> wave;  ///< speeds; 0: rigid
  int moves = -1;            ///< field of the one rigid body here, a free one with its motion of the stage
  Vec3<double> end{};        ///< its velocity at the end of the step, before corrections
  Vec3<double> change{};     ///< of its velocity by contact
  bool free_body = false;    ///< whether there is any
  std::vector<Motion> records;
  std::vector<std::size_t> number;  ///< of the fields, among those that the brick sees
  std::vector<ContactPair> pairs;
  std::vector<int> recorded;  ///< numbers of the pairs in the record; -1: not recorded
  /// Of a free rigid body with one of prescribed motion, apart from `pairs` where the motion at the end
  /// counts.
  struct Rigid {
    RigidContact contact;
    int recorded = -1;      ///< number of the pair in the record
    bool is_first = false;  ///< the free body is the first of the pair
  };
  std::vector<Rigid> rigid_contacts;
  // At the end of the step: velocities at its start, as the particles have them and with Pan's first
  // impulses; those before the impulses that the particles get; and of each pair the share of the normal part
  // of Pan's first impulse that the particles get, and what they get of that impulse.
  std::vector<Vec3<double>> start, nodal_start, taken;
  std::vector<double> share, friction;
  std::vector<Vec3<double>> first_impulse;
  /// Of each pair the impulse that stops the approach at the start: as far as the particles may get it by
  /// their increments, and what they get of it in all.
  std::vector<Vec3<double>> stops, given;

  void clear() {
    fields.clear(), rigid.clear(), wave.clear(), records.clear(), number.clear(), pairs.clear(),
        recorded.clear(), rigid_contacts.clear();
    moves = -1, change = {}, free_body = false;
  }
};

Friction Contact::friction(std::int32_t a, std::int32_t b) const {
  const int first = material_[static_cast<std::size_t>(a)], second = material_[static_cast<std::size_t>(b)];
  if (first < 0 || second < 0) return {};
  return friction_[static_cast<std::size_t>(first) * model_.materials.size() +
                   static_cast<std::size_t>(second)];
}

/// The pairs that touch, of the fields that have mass here.
bool Contact::find_pairs(std::span<const FieldNodes> fields, std::span<const MeetingNodes::Pair> pairs,
                         Node& at) const {
  for (const MeetingNodes::Pair& pair : pairs) {
    const auto of = [&](int field) {
      return static_cast<std::size_t>(std::ranges::find(at.number, static_cast<std::size_t>(field)) -
                                      at.number.begin());
    };
    const std::size_t a = of(pair.first), b = of(pair.second);
    if (a == at.number.size() || b == at.number.size()) continue;
    const bool any_rigid = at.rigid[a] >= 0 || at.rigid[b] >= 0;
    const double ratio = at.fields[a].mass / at.fields[b].mass;
    if (!any_rigid && (ratio > contact_mass_ratio || ratio * contact_mass_ratio < 1)) continue;
    // Two that are driven, or two that move freely, do not act on each other.
    if (at.rigid[a] >= 0 && at.rigid[b] >= 0 && rigid_->is_free(at.rigid[a]) == rigid_->is_free(at.rigid[b]))
      continue;
    const std::int32_t first = fields[at.number[a]].component, second = fields[at.number[b]].component;
    const bool slips = pair.shears || is_slipping(at.rigid[a]) || is_slipping(at.rigid[b]);
    const double coefficient = slips ? 0.0 : friction(first, second).coefficient;
    at.pairs.push_back({static_cast<int>(a), static_cast<int>(b), pair.normal, coefficient});
    at.recorded.push_back(pairs_.number(first, second));
  }
  return !at.pairs.empty();
}

/// Moves the pairs of a free rigid body and one of prescribed motion, which all nodes resolve together, to a
/// list of their own.
void Contact::take_rigid_contacts(Node& at) const {
  std::size_t kept = 0;
  for (std::size_t p = 0; p < at.pairs.size(); ++p) {
    const ContactPair& pair = at.pairs[p];
    const int first = at.rigid[static_cast<std::size_t>(pair.first)],
              second = at.rigid[static_cast<std::size_t>(pair.second)];
    if (first < 0 || second < 0) {
      at.recorded[kept] = at.recorded[p];
      at.pairs[kept++] = pair;
      continue;
    }
    const bool is_first = rigid_->is_free(first);
    const int free = is_first ? first : second, driven = is_first ? second : first;
    at.rigid_contacts.push_back({{.node = at.in_grid,
                                  .free = free,
                                  .driven = driven,
                                  .place = at.place,
                                  .normal = is_first ? -1.0 * pair.normal : pair.normal,
                                  .velocity = velocity_at(rigid_->state(driven), at.place),
                                  .friction = pair.friction},
                                 at.recorded[p],
                                 is_first});
  }
  at.pairs.resize(kept), at.recorded.resize(kept);
}

/// An impulse of this step has done its work where the end of the step finds two fields at rest against each
/// other. The strain must then not part them: that would be work without a source. Corrected velocities
/// become those of particles: there two that have not moved yet are free, as nothing presses them, and one
/// that slides without friction stays free along the surface.
void Contact::hold_pairs(Node& at, Velocity which) const {
  constexpr double round_off = 1e-10;
  const auto of_end = [&](std::size_t f) {
    const double* v = at.records[f].velocity();
    if (at.rigid[f] < 0) return Vec3<double>{v[0], v[1], v[2]};
    const bool moves = which == Velocity::of_correction && static_cast<int>(f) == at.moves;
    return moves ? at.end : at.fields[f].velocity;
  };
  for (ContactPair& pair : at.pairs) {
    const Vec3<double> a = of_end(static_cast<std::size_t>(pair.first)),
                       b = of_end(static_cast<std::size_t>(pair.second)), relative = a - b;
    const double most = round_off * std::sqrt(std::max(dot(a, a), dot(b, b)));
    if (!(std::abs(dot(relative, pair.normal)) <= most)) continue;
    const bool corrects = which == Velocity::of_correction;
    if (corrects && most == 0) continue;
    const bool sticks = std::sqrt(dot(relative, relative)) <= most && !(corrects && pair.friction == 0);
    pair.holds = sticks ? ContactPair::Holds::all : ContactPair::Holds::normal;
  }
}

void Contact::prepare_strain(Node& at, Velocity which) const {
  if (which != Velocity::of_strain) hold_pairs(at, which);
  // With Pan's method the particles still approach. Friction in proportion to that would shear the bodies,
  // and the particles would not get its impulse: energy without a source. What slides strains as it slides.
  // What slides with corrected velocities has had its friction: what holds it along the normal is as often a
  // pull.
  const bool corrects = which == Velocity::of_correction;
  if ((method_ == ContactInput::Method::pan && !at.free_body) || corrects)
    for (ContactPair& pair : at.pairs) pair.friction = 0;
  if (corrects)
    for (Node::Rigid& r : at.rigid_contacts) r.contact.friction = 0;
}

void Contact::resolve_strain(Node& at, Velocity which) const {
  prepare_strain(at, which);
  if (which == Velocity::of_correction) {
    at.start.resize(at.fields.size());
    for (std::size_t f = 0; f < at.fields.size(); ++f)
      at.start[f] = static_cast<int>(f) == at.moves ? at.end : at.fields[f].velocity;
  }
  resolve_contacts(at.fields, at.pairs);
}

/// The strain velocities of the deformable fields.
void Contact::keep_strain(const Node& at) {
  for (std::size_t f = 0; f < at.records.size(); ++f)
    for (int a = 0; at.rigid[f] < 0 && a < 3; ++a)
      at.records[f].strain_velocity()[a] = at.fields[f].velocity[a];
}

/// An impulse on the rigid body with this number, if it is one, that moves with `velocity` there.
void Contact::book_on_rigid(int number, RigidStage stage, const Vec3<double>& place,
                            const Vec3<double>& impulse, const Vec3<double>& velocity,
                            ContactSums& sums) const {
  if (number < 0 || impulse == Vec3<double>{}) return;
  RigidImpulse& of_body = sums.rigid[static_cast<std::size_t>(number)];
  of_body.add(impulse, place - rigid_->state(number).centre, dot(impulse, velocity));
  of_body.contacts += stage == RigidStage::end;
}

/// An impulse on the second field of a pair, and its opposite on the first, where these are rigid bodies;
/// from the velocities at.start to those of the fields.
void Contact::book_pair_on_rigid(const Node& at, const ContactPair& pair, RigidStage stage,
                                 const Vec3<double>& impulse, ContactSums& sums) const {
  const auto book = [&](int field, const Vec3<double>& p) {
    const auto f = static_cast<std::size_t>(field);
    book_on_rigid(at.rigid[f], stage, at.place, p, 0.5 * (at.start[f] + at.fields[f].velocity), sums);
  };
  book(pair.first, -1.0 * impulse);
  book(pair.second, impulse);
}

/// Impulses of resolve_strain() with corrected velocities. They slide without friction, and so take no heat.
void Contact::book_correction(const Node& at, ContactSums& sums) const {
  for (std::size_t p = 0; p < at.pairs.size(); ++p) {
    const ContactPair& pair = at.pairs[p];
    sums.record.add(at.recorded[p], pair.impulse, 0);
    book_pair_on_rigid(at, pair, RigidStage::corrected, pair.impulse, sums);
  }
}

/// The increment of a field that the particles get; of a rigid body by contact, where it is known before.
Vec3<double> Contact::increment(const Node& at, std::size_t f) {
  const double* d = at.records[f].increment();
  if (at.rigid[f] < 0) return {d[0], d[1], d[2]};
  return static_cast<int>(f) == at.moves ? at.change : Vec3<double>{};
}

/// Of the normal part of Pan's first impulse of a pair, the share that the particles get. What the nodes stop
/// is stopped in the particles by the stress of a strain u/c, with the approach u and the larger wave speed c
/// of the two. Above half of c that strain is no small one, from c on there is none: mass that is swept up
/// has no momentum but from the impulse itself (a shell of 200 m/s in soil with waves of 50 m/s).
double Contact::share_of_particles(const Node& at, const ContactPair& pair) const {
  const auto a = static_cast<std::size_t>(pair.first), b = static_cast<std::size_t>(pair.second);
  const double approach = dot(at.start[a] - at.start[b], pair.normal),
               wave = std::max(at.wave[a], at.wave[b]);
  return approach > 0 ? std::clamp(2 * approach / wave - 1, 0.0, 1.0) : 0.0;
}

/// Stops the approach of the velocities at the start, and finds of what stops it the part that the particles
/// may get: their share along the normal, and all of the friction, which is that of this share (4-48). With
/// that of the rest the nodes would slide more slowly than their particles, and contact would book heat that
/// these do not lose. A transfer that takes velocities from the nodes gives them as much of the whole
/// impulse.
void Contact::find_first_impulses(Node& at) const {
  for (std::size_t f = 0; f < at.fields.size(); ++f) at.fields[f].velocity = at.start[f];
  at.friction.clear();
  for (std::size_t p = 0; p < at.pairs.size(); ++p) {
    at.friction.push_back(at.pairs[p].friction);
    at.pairs[p].friction *= at.share[p];
  }
  resolve_contacts(at.fields, at.pairs);
  at.stops.clear(), at.given.clear();
  for (std::size_t p = 0; p < at.pairs.size(); ++p) {
    ContactPair& pair = at.pairs[p];
    const double share = at.share[p];
    Vec3<double> stops = share * pair.impulse;
    if (pair.friction > 0 && share < 1)
      stops = stops + (1 - share) * (pair.impulse - dot(pair.impulse, pair.normal) * pair.normal);
    at.stops.push_back(stops);
    at.given.push_back(stops + transfer_.share_of_nodes * (pair.impulse - stops));
    pair.friction = at.friction[p];
  }
}

/// From the first impulses, those of Pan's method and the velocities that they and the forces lead to.
void Contact::correct_start(Node& at, ContactInput::Method method) const {
  const std::size_t count = at.fields.size();
  for (std::size_t f = 0; f < count; ++f) {
    at.nodal_start[f] = at.fields[f].velocity;
    at.fields[f].velocity = at.fields[f].velocity + increment(at, f);
  }
  at.first_impulse = at.given;
  if (method != ContactInput::Method::pan) return;
  for (std::size_t f = 0; f < count; ++f) at.taken[f] = at.fields[f].velocity;
  for (std::size_t p = 0; p < at.pairs.size(); ++p) {
    const ContactPair& pair = at.pairs[p];
    const auto a = static_cast<std::size_t>(pair.first), b = static_cast<std::size_t>(pair.second);
    at.taken[a] = at.taken[a] + (1 / at.fields[a].mass) * at.stops[p];
    at.taken[b] = at.taken[b] - (1 / at.fields[b].mass) * at.stops[p];
  }
}

/// An impulse consists of a blow, which stops the approach at the start of the step, and of the part that
/// opposes the other forces. Here the velocities by the blows, as far as the particles get them.
void Contact::find_blows(const Node& at, std::span<Vec3<double>> by_field) const {
  std::ranges::fill(by_field, Vec3<double>{});
  for (std::size_t p = 0; p < at.pairs.size(); ++p) {
    const ContactPair& pair = at.pairs[p];
    const Vec3<double> first = at.given[p], all = pair.impulse + at.first_impulse[p];
    const double size = dot(first, first);
    if (!(size > 0)) continue;
    const Vec3<double> blow = std::clamp(dot(all, first) / size, 0.0, 1.0) * first;
    const auto a = static_cast<std::size_t>(pair.first), b = static_cast<std::size_t>(pair.second);
    if (at.rigid[a] < 0) by_field[a] = by_field[a] - (1 / at.fields[a].mass) * blow;
    if (at.rigid[b] < 0) by_field[b] = by_field[b] + (1 / at.fields[b].mass) * blow;
  }
}

/// Velocities at the end of the step, and what the particles get.
void Contact::resolve_end(Node& at, ContactSums& sums, bool counts) const {
  const std::size_t count = at.fields.size();
  // With a free rigid body the nodes are brought to its velocity after all forces, and the particles get all
  // of that impulse (thesis 5-14, 5-22): it has no stress that could give them the momentum later.
  const ContactInput::Method method = at.free_body ? ContactInput::Method::bardenhagen : method_;
  at.taken.resize(count), at.start.resize(count);
  at.share.assign(at.pairs.size(), 1.0), at.first_impulse.assign(at.pairs.size(), Vec3<double>{});
  for (std::size_t f = 0; f < count; ++f)
    at.taken[f] = at.fields[f].velocity, at.start[f] = at.taken[f] - increment(at, f);
  at.nodal_start = at.start;
  if (method == ContactInput::Method::pan)
    for (std::size_t p = 0; p < at.pairs.size(); ++p) at.share[p] = share_of_particles(at, at.pairs[p]);
  find_first_impulses(at);
  if (method == ContactInput::Method::bardenhagen)
    for (std::size_t f = 0; f < count; ++f) at.fields[f].velocity = at.taken[f];
  else
    correct_start(at, method);
  for (const ContactPair& pair : at.pairs) {
    const auto a = static_cast<std::size_t>(pair.first), b = static_cast<std::size_t>(pair.second);
    sums.fastest = std::max(sums.fastest, dot(at.taken[a] - at.taken[b], pair.normal));
  }
  resolve_contacts(at.fields, at.pairs);
  for (std::size_t f = 0; f < count; ++f) {
    if (at.rigid[f] >= 0) continue;
    for (int a = 0; a < 3; ++a) {
      at.records[f].increment()[a] += at.fields[f].velocity[a] - at.taken[f][a];
      at.records[f].velocity()[a] = at.fields[f].velocity[a];
    }
  }
  for (const Node::Rigid& r : at.rigid_contacts) {
    const RigidContact& c = r.contact;
    const Vec3<double> u = velocity_at(rigid_->state(c.free), c.place) - c.velocity;
    sums.fastest = std::max(sums.fastest, -dot(u, c.normal));
  }
  if (counts) {
    book(at, sums);
    book_rigid(at, RigidStage::end, sums);
  }
}

/// Energy and impulses of resolve_end().
void Contact::book(const Node& at, ContactSums& sums) const {
  const double nodal = transfer_.share_of_nodes;
  const auto given = [&](std::size_t f) {
    if (at.rigid[f] < 0)
      return (1 - nodal) * increment(at, f) + nodal * (at.fields[f].velocity - at.start[f]);
    return static_cast<int>(f) == at.moves ? increment(at, f) : at.fields[f].velocity - at.taken[f];
  };
  for (std::size_t p = 0; p < at.pairs.size(); ++p) {
    const ContactPair& pair = at.pairs[p];
    const auto a = static_cast<std::size_t>(pair.first), b = static_cast<std::size_t>(pair.second);
    const Vec3<double> impulse = pair.impulse + at.first_impulse[p];
    // Of the kinetic energy that a step changes, an impulse P takes P.(u + u')/2, where the relative velocity
    // of the fields is u at its start and u' with all that the particles get.
    const Vec3<double> mean = at.start[a] - at.start[b] + 0.5 * (given(a) - given(b));
    // The part of Pan's first impulses that the particles do not get stops the approach of the nodes without
    // stopping theirs, and the strain follows the nodes: their approach counts for the second impulses.
    const Vec3<double> stopped = (1 - nodal) * (1 - at.share[p]) *
                                 (at.nodal_start[a] - at.start[a] - (at.nodal_start[b] - at.start[b]));
    const double pressing = dot(impulse, pair.normal) * dot(mean, pair.normal) +
                            dot(pair.impulse, pair.normal) * dot(stopped, pair.normal);
    const double heat = dot(impulse, mean) - dot(impulse, pair.normal) * dot(mean, pair.normal);
    // The velocities of order 1 approach in every step, smooth as they are; those of the particles do not.
    sums.record.dissipated.add(transfer_.corrects ? heat : pressing + heat);
    sums.record.add(at.recorded[p], impulse, heat);
    book_pair_on_rigid(at, pair, RigidStage::end, impulse, sums);
  }
}

/// Energy and impulses of a free rigid body with those of prescribed motion.
void Contact::book_rigid(const Node& at, RigidStage stage, ContactSums& sums) const {
  for (const Node::Rigid& r : at.rigid_contacts) {
    const RigidContact& c = r.contact;
    const Vec3<double> impulse = rigid_->impulse_of(stage, c);
    if (impulse == Vec3<double>{}) continue;
    const Vec3<double> before = stage == RigidStage::end ? velocity_at(rigid_->state(c.free), c.place)
                                                         : rigid_->velocity(RigidStage::end, c.free, c.place);
    const Vec3<double> mean = 0.5 * (before + rigid_->velocity(stage, c.free, c.place));
    const Vec3<double> relative = mean - c.velocity;
    const double pressing = dot(impulse, c.normal) * dot(relative, c.normal), all = dot(impulse, relative);
    sums.record.dissipated.add(-all);
    sums.record.add(r.recorded, r.is_first ? -1.0 * impulse : impulse, pressing - all);
    book_on_rigid(c.free, stage, c.place, impulse, mean, sums);
    book_on_rigid(c.driven, stage, c.place, -1.0 * impulse, c.velocity, sums);
  }
}

/// The fields with mass at a node, and their pairs that touch; false without any.
bool Contact::take_node(const BrickGrid& grid, Slot s, Velocity which, std::span<FieldNodes> fields,
                        const MeetingNodes::Node& node, Node& at) const {
  at.clear();
  const std::array<int, 3> in_brick = grid.shape().node(node.number);
  at.place = grid.geometry().node_place(grid.brick(s).coord, in_brick);
  int free_bodies = 0;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const Motion record{fields[f].motion.data() + node_doubles * node.number};
    if (!(record.mass() > 0)) continue;
    const double* v = which == Velocity::of_end ? record.velocity() : record.strain_velocity();
    const int number = rigid(fields[f].component);
    if (number >= 0) {
      if (at.moves < 0 || rigid_->is_free(number)) at.moves = static_cast<int>(at.fields.size());
      free_bodies += rigid_->is_free(number);
      const bool has_met = which == Velocity::of_correction && rigid_->is_free(number);
      at.fields.push_back(
          {rigid_->mass_at_node(number), has_met ? rigid_->velocity(RigidStage::end, number, at.place)
                                                 : velocity_at(rigid_->state(number), at.place)});
    } else {
      at.fields.push_back({record.mass(), {v[0], v[1], v[2]}});
    }
    at.rigid.push_back(number);
    at.wave.push_back(wave_[static_cast<std::size_t>(fields[f].component)]);
    at.records.push_back(record);
    at.number.push_back(f);
  }
  at.free_body = free_bodies > 0;
  if (free_bodies != 1 || which == Velocity::of_strain) {
    at.moves = -1;
  } else {
    ContactField& moves = at.fields[static_cast<std::size_t>(at.moves)];
    const auto motion = [&](RigidStage stage) {
      return rigid_->velocity(stage, at.rigid[static_cast<std::size_t>(at.moves)], at.place);
    };
    // The strain meets the motion with which the bodies move.
    const bool corrected = which == Velocity::of_correction ||
                           (which == Velocity::of_strain_after_end && transfer_.moves_corrected);
    at.end = motion(RigidStage::end);
    at.change = at.end - moves.velocity;
    moves = {std::numeric_limits<double>::infinity(), corrected ? motion(RigidStage::corrected) : at.end};
  }
  if (!find_pairs(fields, meetings(s).pairs_of(node), at)) return false;
  if (at.free_body && which != Velocity::of_strain) {
    at.in_grid = number_in_grid(grid, s, in_brick);
    take_rigid_contacts(at);
  }
  return true;
}

void Contact::resolve(const BrickGrid& grid, Slot s, Velocity which, std::span<FieldNodes> fields,
                      ContactSums& sums) const {
  const BoundaryFaces faces(grid, s);
  sums.record.pairs.resize(pairs_.size());
  if (rigid_ != nullptr) sums.rigid.resize(rigid_->count());
  const bool of_end = which == Velocity::of_end;
  if (of_end)
    for (FieldNodes& field : fields) field.blow.assign(field.motion.size(), 0.0);
  Node at;
  std::vector<Vec3<double>> blows;
  for (const MeetingNodes::Node& node : meetings(s).nodes) {
    if (!take_node(grid, s, which, fields, node, at)) continue;
    if (!of_end) {
      resolve_strain(at, which);
      keep_strain(at);
      if (which == Velocity::of_correction && node.counts) {
        book_correction(at, sums);
        book_rigid(at, RigidStage::corrected, sums);
      }
      continue;
    }
    resolve_end(at, sums, node.counts);
    blows.resize(at.fields.size());
    find_blows(at, blows);
    for (std::size_t f = 0; f < blows.size(); ++f) {
      double* const to = Motion{fields[at.number[f]].blow.data() + node_doubles * node.number}.velocity();
      for (int a = 0; a < 3; ++a) to[a] = blows[f][a];
      // Of the nodes, for that of the particles (contact_operations.hpp, book_blows()).
      if (node.counts && at.rigid[f] < 0 && !transfer_.corrects)
        sums.record.dissipated.add(0.5 * at.fields[f].mass * dot(blows[f], blows[f]));
    }
  }
  for (FieldNodes& field : fields) {
    faces.fill(field.motion.data());
    if (of_end) faces.fill(field.blow.data());
  }
}

bool Contact::sees_free_body(Slot s) const {
  return std::ranges::any_of(seen(s), [&](std::int32_t component) {
    const int number = rigid(component);
    return number >= 0 && rigid_->is_free(number);
  });
}

void Contact::find_rigid_nodes(const BrickGrid& grid, Slot s, RigidStage stage, std::span<FieldNodes> fields,
                               std::vector<RigidNode>& to) const {
  const Velocity which = stage == RigidStage::end ? Velocity::of_end : Velocity::of_correction;
  Node at;
  for (const MeetingNodes::Node& node : meetings(s).nodes) {
    if (!node.counts || !take_node(grid, s, which, fields, node, at) || !at.free_body) continue;
    if (stage == RigidStage::corrected) prepare_strain(at, which);
    to.push_back({at.place, at.fields, at.rigid, at.moves, at.pairs, {}});
    for (const Node::Rigid& r : at.rigid_contacts) to.back().contacts.push_back(r.contact);
  }
}

void Contact::respond(const RigidNode& node, RigidStage stage, std::span<RigidResponse> to) const {
  if (node.pairs.empty()) return;
  std::vector<ContactField> fields = node.fields;
  std::vector<ContactPair> pairs = node.pairs;
  const auto at = [&](int f) { return static_cast<std::size_t>(f); };
  if (node.moves >= 0)
    fields[at(node.moves)].velocity = rigid_->velocity(stage, node.rigid[at(node.moves)], node.place);
  for (ContactPair& pair : pairs)
    if (is_slipping(node.rigid[at(pair.first)]) || is_slipping(node.rigid[at(pair.second)]))
      pair.friction = 0;
  const std::vector<ContactField> before = fields;
  resolve_contacts(fields, pairs);
  for (const ContactPair& pair : pairs) {
    for (const int f : {pair.first, pair.second}) {
      const int number = node.rigid[at(f)], other = f == pair.first ? pair.second : pair.first;
      if (number < 0 || !rigid_->is_free(number) || pair.impulse == Vec3<double>{}) continue;
      Mat3<double> change{};
      if (f == node.moves) {
        const Vec3<double> approach = before[at(pair.first)].velocity - before[at(pair.second)].velocity;
        const double mass = before[at(other)].mass;
        const bool alone = pairs.size() == 1 && !rigid_->meets_rigid(number);
        change = alone ? impulse_derivative(pair, approach, mass) : impulse_secant(pair, approach, mass);
      }
      to[at(number)].add(f == pair.first ? -1.0 * pair.impulse : pair.impulse,
                         node.place - rigid_->state(number).centre, change);
    }
  }
}

}  // namespace mpm::core
