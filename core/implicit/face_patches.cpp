#include "core/implicit/face_patches.hpp"

#include <algorithm>
#include <cmath>

#include "core/communication/gather_records.hpp"

namespace mpm::core {

PatchSums& PatchSums::operator+=(const PatchSums& more) {
  area += more.area;
  stiffness += more.stiffness;
  place = place + more.place;
  normal = normal + more.normal;
  known += more.known;
  stuck += more.stuck;
  pressure += more.pressure;
  force = force + more.force;
  gap = gap + more.gap;
  return *this;
}

void FacePatches::clear() {
  patches_.clear();
  number_.clear();
}

void FacePatches::add(const FacePatch::Key& key, const FaceTouch& touch, const PatchSums& sums) {
  const auto [at, is_new] = number_.try_emplace(key, patches_.size());
  if (is_new) patches_.emplace_back().key = key;
  FacePatch& patch = patches_[at->second];
  patch.points.push_back(touch.point);
  patch.sums += sums;
  patch.on_walls &= touch.held;
  auto part = std::ranges::find(patch.parts, touch.field, &FacePatch::Part::field);
  if (part == patch.parts.end()) part = patch.parts.insert(part, {touch.field, {}});
  for (const auto& [node, weight] : touch.weights) {
    const auto known = std::ranges::find(part->weights, node, &std::pair<std::int32_t, double>::first);
    if (known == part->weights.end())
      part->weights.push_back({node, sums.area * weight});
    else
      known->second += sums.area * weight;
  }
}

void FacePatches::complete() {
  share_sums();
  find_unknowns();
  if (are_shared_) share_unknowns();
}

/// Whether bricks may share a patch: where they take particles by cell, those on both sides of its node.
bool FacePatches::is_shared(const FacePatch::Key& key) const {
  const GridGeometry& g = model_.grid->geometry();
  if (g.site == Site::node || key[2] != FacePatch::many_points) return false;
  bool shared = false;
  for (std::size_t a = 0; a < 3; ++a)
    shared |= static_cast<std::int64_t>(a) != key[3] / 2 && key[4 + a] % brick_cells == 0 && key[4 + a] > 0 &&
              key[4 + a] < g.cells[a];
  return shared;
}

void FacePatches::share_sums() {
  struct Record {
    FacePatch::Key key;
    PatchSums sums;
    unsigned on_walls;
    int rank;
  };
  std::vector<Record> mine;
  for (const FacePatch& patch : patches_)
    if (is_shared(patch.key)) mine.push_back({patch.key, patch.sums, patch.on_walls, ranks_.rank()});
  std::map<FacePatch::Key, Record> all;
  for (const Record& record : gather_records(std::span<const Record>(mine), ranks_)) {
    const auto [at, is_new] = all.try_emplace(record.key, record);
    if (is_new) continue;
    at->second.sums += record.sums;
    at->second.on_walls &= record.on_walls;
  }
  are_shared_ = !all.empty();
  for (FacePatch& patch : patches_) {
    const auto whole = all.find(patch.key);
    if (whole == all.end()) continue;
    patch.sums = whole->second.sums;
    patch.on_walls = whole->second.on_walls;
    patch.counts = whole->second.rank == ranks_.rank();
  }
}

void FacePatches::find_unknowns() {
  for (FacePatch& patch : patches_)
    for (const FacePatch::Part& part : patch.parts) {
      const NodeUnknowns::Node* nodes = unknowns_.of(fields_.all()[part.field]);
      for (const auto& [node, weight] : part.weights) {
        const NodeUnknowns::Node& n = nodes[node];
        const auto known = std::ranges::find(patch.unknowns, n.number) - patch.unknowns.begin();
        if (known == std::ssize(patch.unknowns)) {
          patch.unknowns.push_back(n.number);
          patch.factors.push_back({});
        }
        const unsigned held = nodes[n.from].held | patch.on_walls;
        for (int a = 0; a < 3; ++a)
          if ((held >> a & 1) == 0)
            patch.factors[static_cast<std::size_t>(known)][a] += n.sign[a] * weight / patch.sums.area;
      }
    }
}

void FacePatches::share_unknowns() {
  struct Record {
    FacePatch::Key key;
    std::int64_t unknown;
    Vec3<double> factor;
  };
  std::vector<Record> mine;
  for (const FacePatch& patch : patches_) {
    if (!is_shared(patch.key)) continue;
    for (std::size_t i = 0; i < patch.unknowns.size(); ++i)
      mine.push_back({patch.key, patch.unknowns[i], patch.factors[i]});
  }
  std::map<FacePatch::Key, std::map<std::int64_t, Vec3<double>>> all;
  for (const Record& record : gather_records(std::span<const Record>(mine), ranks_)) {
    Vec3<double>& factor = all[record.key][record.unknown];
    factor = factor + record.factor;
  }
  for (FacePatch& patch : patches_) {
    const auto whole = all.find(patch.key);
    if (whole == all.end()) continue;
    patch.unknowns.clear();
    patch.factors.clear();
    for (const auto& [unknown, factor] : whole->second) {
      patch.unknowns.push_back(unknown);
      patch.factors.push_back(factor);
    }
  }
}

std::vector<Vec3<double>> FacePatches::displacements(const AlignedDoubles& of_nodes) const {
  struct Record {
    FacePatch::Key key;
    Vec3<double> sum;
  };
  std::vector<Vec3<double>> found;
  std::vector<Record> mine;
  for (const FacePatch& patch : patches_) {
    Vec3<double> sum{};
    for (const FacePatch::Part& part : patch.parts) {
      const double* records =
          of_nodes.data() + static_cast<std::size_t>(node_doubles * unknowns_.nodes()) * part.field;
      for (const auto& [node, weight] : part.weights)
        for (int a = 0; a < 3; ++a) sum[a] += weight * records[node_doubles * node + a];
    }
    found.push_back((1 / patch.sums.area) * sum);
    if (are_shared_ && is_shared(patch.key)) mine.push_back({patch.key, sum});
  }
  if (!are_shared_) return found;
  std::map<FacePatch::Key, Vec3<double>> all;
  for (const Record& record : gather_records(std::span<const Record>(mine), ranks_)) {
    Vec3<double>& sum = all[record.key];
    sum = sum + record.sum;
  }
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    const FacePatch& patch = patches_[p];
    const auto whole = all.find(patch.key);
    if (whole != all.end()) found[p] = (1 / patch.sums.area) * whole->second;
  }
  return found;
}

void FacePatches::add_force(const FacePatch& patch, const Vec3<double>& force) {
  for (const FacePatch::Part& part : patch.parts) {
    const BrickField& field = fields_.all()[part.field];
    const NodeUnknowns::Node* nodes = unknowns_.of(field);
    double* to = model_.grid->contributions(NodeArray::first, field.slot, field.number);
    for (const auto& [node, weight] : part.weights) {
      double* record = to + node_doubles * nodes[node].from;
      for (int a = 0; a < 3; ++a) {
        const double f = weight / patch.sums.area * force[a];
        record[node_field::force.first + a] += nodes[node].sign[a] * f;
        record[node_field::support.first] += std::abs(f);
      }
    }
  }
}

}  // namespace mpm::core
