#include "core/discretise/parts.hpp"

#include <variant>

namespace mpm::core {

namespace {

bool exists(const Scene& scene, BodyPlace place) {
  return place.component < scene.components.size() &&
         place.body < scene.components[place.component].bodies.size();
}

}  // namespace

Parts::Parts(const Scene& scene, const BodyInput& body) : scene_(scene), shapes_(0) {
  shapes_ = shapes_of(body);
}

double Parts::shapes_of(const BodyInput& part) {
  const auto [found, first_visit] = seen_.emplace(&part, 0);
  if (!first_visit) {
    if (found->second > 0) return found->second;
    circular_ = true;
    if (&part == bodies_.front() && circle_.empty()) {
      for (const BodyInput* b : path_) circle_.push_back(b->name);
      circle_.push_back(part.name);
      circle_by_subtrahend_ = by_subtrahend_;
    }
    return 1;
  }
  bodies_.push_back(&part);
  double shapes = 1;
  const auto* difference = std::get_if<BoolGeometry>(&part.geometry);
  if (difference != nullptr && static_cast<double>(bodies_.size()) > 2 * most_shapes) {
    cut_ = true;
  } else if (difference != nullptr) {
    shapes = 0;
    path_.push_back(&part);
    for (const bool subtrahend : {false, true}) {
      if (path_.size() == 1) by_subtrahend_ = subtrahend;
      const BodyPlace place = subtrahend ? difference->subtrahend : difference->minuend;
      if (!exists(scene_, place))
        missing_ = true;
      else
        shapes += shapes_of(body_at(scene_, place));
    }
    path_.pop_back();
  }
  seen_[&part] = shapes > 0 ? shapes : 1;
  return seen_[&part];
}

}  // namespace mpm::core
