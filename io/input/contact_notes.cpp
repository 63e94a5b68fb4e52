#include "io/input/contact_notes.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <fmt/format.h>

#include "core/contact/component_contact.hpp"
#include "core/contact/contact_record.hpp"
#include "core/discretise/solid_box.hpp"

namespace mpm::io {

namespace {

bool is_rigid(const core::Scene& scene, const core::BodyInput& body) {
  return core::is_rigid(scene.materials[body.material]);
}

/// Contact cannot change the motion of driven rigid bodies.
void note_driven(const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  const auto fixed = [](const core::BodyInput& body) {
    return !body.constrain_rigid_position && body.prescribed_velocity == core::Vec3<double>{} &&
           body.prescribed_velocity_expressions.empty();
  };
  const core::BodyInput *moves = nullptr, *other = nullptr;
  core::for_each_active_body(scene, [&](int, const core::BodyInput& body) {
    if (!is_rigid(scene, body) || !core::is_driven(body)) return;
    if (moves == nullptr && !fixed(body))
      moves = &body;
    else
      other = &body;
  });
  if (moves == nullptr || other == nullptr) return;
  notes.push_back({moves->source.file,
                   moves->source.line,
                   "Body",
                   {},
                   {},
                   fmt::format("rigid bodies '{}' and '{}' both have a prescribed motion: where they meet "
                               "contact cannot part them, and the run stops",
                               moves->name, other->name)});
}

/// A plate that falls, or is pushed away, where it was to be held.
void note_without_law(const Node& root, const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  const std::vector<Node> components = root.children("Component");
  const core::BodyInput* first = nullptr;
  int more = 0;
  for (std::size_t c = 0; c < std::min(components.size(), scene.components.size()); ++c) {
    const std::vector<Node> bodies = components[c].children("Body");
    for (std::size_t b = 0; b < std::min(bodies.size(), scene.components[c].bodies.size()); ++b) {
      const core::BodyInput& body = scene.components[c].bodies[b];
      if (body.deactivated || body.for_bool || !is_rigid(scene, body)) continue;
      constexpr std::string_view laws[] = {"InitialVelocity", "PrescribedVelocity", "PrescribedAcceleration",
                                           "HarmExcit",       "BodyForce",          "ConstrainRigidPosition"};
      if (std::ranges::any_of(laws, [&](std::string_view law) { return bodies[b].child(law).has_value(); }))
        continue;
      if (first == nullptr)
        first = &body;
      else
        ++more;
    }
  }
  if (first == nullptr) return;
  notes.push_back(
      {first->source.file,
       first->source.line,
       "Body",
       {},
       {},
       fmt::format(
           "rigid body '{}'{} has no law of motion: from rest, it moves freely under contact{}. Give it "
           "PrescribedVelocity where it is held or driven, InitialVelocity where it is free",
           first->name, more > 0 ? fmt::format(" (and {} more)", more) : "",
           scene.solution.gravity == core::Vec3<double>{} ? "" : " and gravity")});
}

/// Where a free rigid body touches, contact is always of type 1 (core/contact/contact_impulses.cpp).
void note_free(const Node& root, const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  const std::optional<Node> contact = root.child("Contact");
  if (!contact || scene.contact.method == core::ContactInput::Method::bardenhagen) return;
  const core::BodyInput* free = nullptr;
  core::for_each_active_body(scene, [&](int, const core::BodyInput& body) {
    if (is_rigid(scene, body) && !body.constrain_rigid_position && !body.prescribed_velocity) free = &body;
  });
  if (free == nullptr) return;
  notes.push_back({scene.provenance.path, contact->line(), "Contact", "contact_type",
                   std::to_string(static_cast<int>(scene.contact.method)),
                   fmt::format("rigid body '{}' is free: where it touches others contact is of type 1, since "
                               "it has no stress that could oppose their forces",
                               free->name)});
}

/// Explicit steps know a rigid body's surface only where gaps are measured between faces.
void note_rough(const Node& root, const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  const std::optional<Node> friction = root.child("Friction");
  const bool knows_faces =
      scene.contact.measures_gaps() && scene.contact.distance == core::ContactInput::Distance::surfaces;
  if (!friction || knows_faces || scene.solution.integration == core::Integration::implicit) return;
  const auto named_rigid = [&](const std::string& name) {
    const auto material = std::ranges::find(scene.materials, name, &core::MaterialInput::name);
    return material != scene.materials.end() && core::is_rigid(*material);
  };
  for (const Node& pair : friction->children("Coefficient")) {
    if (!pair.boolean("rough") || !(named_rigid(pair.word("mat1")) || named_rigid(pair.word("mat2"))))
      continue;
    notes.push_back(
        {scene.provenance.path, pair.line(), "Coefficient", "rough", "1",
         "friction of the rigid body acts at nodes inside it only with distance_type=\"2\" and min_distance; "
         "without, what sticks is held above it, as far as contact reaches"});
  }
}

/// The largest set of deformable components whose normals have the same weight; two spheres have no edges.
std::vector<std::size_t> tied_components(const core::Scene& scene) {
  struct Of {
    std::size_t component;
    double weight;
    bool edges;
  };
  std::vector<Of> all;
  core::for_each_active_body(scene, [&](int component, const core::BodyInput& body) {
    if (is_rigid(scene, body)) return;
    const auto c = static_cast<std::size_t>(component);
    const double weight = core::normal_weight(scene, c, body.material);
    const bool edges = !std::holds_alternative<core::SphereGeometry>(body.geometry);
    if (all.empty() || all.back().component != c) return all.push_back({c, weight, edges});
    all.back().weight = std::max(all.back().weight, weight);
    all.back().edges |= edges;
  });
  std::vector<std::size_t> largest;
  for (const Of& first : all) {
    std::vector<std::size_t> tied;
    bool edges = false;
    for (const Of& other : all) {
      if (other.weight != first.weight) continue;
      tied.push_back(other.component);
      edges |= other.edges;
    }
    if ((edges || tied.size() > 2) && tied.size() > std::max<std::size_t>(largest.size(), 1)) largest = tied;
  }
  return largest;
}

std::string names_of(const core::Scene& scene, const std::vector<std::size_t>& components) {
  constexpr std::size_t most = 5;
  std::string names;
  const std::size_t count = std::min(components.size(), most);
  for (std::size_t i = 0; i < count; ++i)
    names += fmt::format("{}'{}'",
                         i == 0                       ? ""
                         : i + 1 == components.size() ? " and "
                                                      : ", ",
                         scene.components[components[i]].name);
  if (components.size() > most) names += fmt::format(" and {} more", components.size() - most);
  return names;
}

void note_tied_weights(const Node& root, const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  const std::optional<Node> contact = root.child("Contact");
  if (!contact || scene.contact.normal != core::ContactInput::Normal::mass_gradient) return;
  const std::vector<std::size_t> tied = tied_components(scene);
  if (tied.size() < 2) return;
  notes.push_back(
      {scene.provenance.path,
       contact->line(),
       "Contact",
       {},
       {},
       fmt::format(
           "components {} have the same normal_vector_weight{}: their normals are the means of both bodies' "
           "gradients of mass, which tilt at the edges of a body on a wider one and hold it there{}. Set "
           "contact_normal to automatic or regression, or give the wider body the larger weight",
           names_of(scene, tied), scene.contact.automatic_weights ? ", by their stiffness" : "",
           tied.size() > 2 ? ", and where three of them meet the normals of the pairs do not go together"
                           : "")});
}

/// core/contact/contact_record.hpp
void note_pairs(const Node& root, const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  const std::optional<Node> contact = root.child("Contact");
  const std::size_t components = core::component_count(scene);
  if (!contact || !scene.contact.record_force || components <= core::ContactPairs::most_components) return;
  notes.push_back(
      {scene.provenance.path, contact->line(), "Contact", "record_contact_force", "1",
       fmt::format("the scene has {} components{}: with more than {} only the force between the "
                   "first two is recorded",
                   components, core::has_failed_component(scene) ? " with that of failed particles" : "",
                   core::ContactPairs::most_components)});
}

/// Measured in tests/system/physics_contact.py: USF, and USAVG at the start of a step, strain before they
/// know the step's impulses. Those of type 0 follow from the forces, whose strains USAVG has at the end.
void note_scheme(const Node& root, const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  const std::optional<Node> contact = root.child("Contact"), solution = root.child("Solution");
  const core::Scheme scheme = scene.solution.scheme;
  if (!contact || !solution || scheme == core::Scheme::musl) return;
  if (scheme == core::Scheme::usavg && scene.contact.method == core::ContactInput::Method::pan) return;
  notes.push_back(
      {scene.provenance.path, solution->line(), "Solution", "algorithm", solution->word("algorithm"),
       fmt::format("with Contact, bodies that rebound gain energy, as their strains do not follow "
                   "the impulses of contact. Use MUSL{}",
                   scheme == core::Scheme::usavg ? ", or contact_type 0" : "")});
}

/// Two bodies of different components whose bounding boxes are less than a cell apart at the start.
std::string touching(const core::Scene& scene) {
  struct Item {
    core::SolidBox box;
    std::size_t component;
    const std::string* name;
  };
  std::vector<Item> items;
  core::for_each_active_body(scene, [&](int component, const core::BodyInput& body) {
    const core::SolidBox box = core::solid_box(scene, body);
    if (!box.empty()) items.push_back({box, static_cast<std::size_t>(component), &body.name});
  });
  std::ranges::sort(items, {}, [](const Item& item) { return item.box.lower[0]; });
  std::size_t left = 1'000'000;  // maximum number of pairs to test; in a larger scene the note names none
  for (std::size_t i = 0; i < items.size(); ++i) {
    for (std::size_t j = i + 1; j < items.size() && left-- > 0; ++j) {
      const auto apart = [&](std::size_t a) {
        const double cell = scene.grid.axes[a].cell_size;
        return items[j].box.lower[a] - items[i].box.upper[a] > cell ||
               items[i].box.lower[a] - items[j].box.upper[a] > cell;
      };
      if (apart(0)) break;
      if (items[i].component != items[j].component && !apart(1) && !apart(2))
        return fmt::format("bodies '{}' and '{}' touch at the start; ", *items[i].name, *items[j].name);
    }
  }
  return {};
}

}  // namespace

void note_contact(const Node& root, const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  note_driven(scene, notes);
  note_without_law(root, scene, notes);
  note_free(root, scene, notes);
  note_rough(root, scene, notes);
  note_scheme(root, scene, notes);
  note_tied_weights(root, scene, notes);
  note_pairs(root, scene, notes);
}

void note_no_contact(const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  const core::ComponentInput* second = nullptr;
  int first = -1, count = 0, rigid_bodies = 0;
  core::for_each_active_body(scene, [&](int component, const core::BodyInput& body) {
    ++count;
    if (is_rigid(scene, body)) ++rigid_bodies;
    if (first < 0) first = component;
    if (component != first && second == nullptr)
      second = &scene.components[static_cast<std::size_t>(component)];
  });
  const auto add = [&](const core::SourceLocation& at, std::string message) {
    notes.push_back({at.file, at.line, "Component", {}, {}, std::move(message)});
  };
  if (rigid_bodies > 1)
    return add(scene.components.front().source, "rigid bodies pass through each other without contact");
  if (second != nullptr && rigid_bodies < count)
    add(second->source, touching(scene) +
                            "without contact, bodies of different components that come within a cell of each "
                            "other stick together: they neither slide nor separate");
}

}  // namespace mpm::io
