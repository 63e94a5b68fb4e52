// The motion of the free rigid bodies in a step, by trials of all of them at once: the contacts of bodies of
// prescribed motion with them, and the sums over the nodes of all ranks.
#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "core/communication/gather_records.hpp"
#include "core/contact/rigid_bodies.hpp"
#include "core/step/stepper.hpp"

namespace mpm::core {

void RigidBodies::gather(RigidStage stage, std::span<const RigidContact> mine) {
  if (std::ranges::none_of(bodies_, &Rigid::driven)) return;  // on all ranks
  std::vector<RigidContact>& all = contacts(stage);
  all = gather_records(mine, ranks_);
  std::ranges::sort(all, [](const RigidContact& a, const RigidContact& b) { return a < b; });
}

std::span<RigidContact> RigidBodies::contacts_of(RigidStage stage, std::size_t number) {
  const auto body = static_cast<std::int32_t>(number);
  std::vector<RigidContact>& all = contacts(stage);
  const auto first = std::ranges::lower_bound(all, body, {}, &RigidContact::free),
             last = std::ranges::upper_bound(all, body, {}, &RigidContact::free);
  return {first, last};
}

Vec3<double> RigidBodies::impulse_of(RigidStage stage, const RigidContact& contact) const {
  const std::vector<RigidContact>& all = contacts(stage);
  const auto at = std::lower_bound(all.begin(), all.end(), contact);
  if (at == all.end() || contact < *at)
    throw std::logic_error("a node of two rigid bodies was not among those that found their motion");
  return at->impulse;
}

void RigidBodies::fail_pressed(RigidStage stage, std::size_t number) {
  const auto name = [&](std::size_t r) {
    return model_.bodies[static_cast<std::size_t>(bodies_[r].body)].name;
  };
  std::vector<std::string> others;
  for (const RigidContact& contact : contacts_of(stage, number)) {
    std::string other = name(static_cast<std::size_t>(contact.driven));
    if (contact.impulse != Vec3<double>{} && std::ranges::find(others, other) == others.end())
      others.push_back(std::move(other));
  }
  std::string list;
  for (const std::string& other : others) list += fmt::format("{}'{}'", list.empty() ? "" : ", ", other);
  throw NumericalFailure(fmt::format(
      "step {}, time {:.6g}: no impulses keep the free rigid body '{}' from entering the rigid bodies of "
      "prescribed motion that it touches ({}). Where they close on it from several sides, leave it room or "
      "make one of them deformable",
      model_.clock.step + 1, model_.clock.time, name(number), list));
}

void RigidBodies::find_motion(RigidStage stage, std::span<const RigidContact> contacts,
                              const std::function<void(std::span<RigidResponse>)>& respond) {
  gather(stage, contacts);
  for (std::size_t r = 0; r < bodies_.size(); ++r) bodies_[r].meets_rigid = !contacts_of(stage, r).empty();
  if (!try_motion(stage, respond) && stage == RigidStage::end) {
    for (Rigid& rigid : bodies_) rigid.slips = !rigid.found;
    try_motion(stage, respond);
  }
  if (stage == RigidStage::corrected) return;
  for (Rigid& rigid : bodies_) {
    if (rigid.driven) continue;
    rigid.corrected = rigid.end;
    move_with(rigid, rigid.end);
  }
}

/// Trials from the free motion on; false where they do not find the motion of every body.
bool RigidBodies::try_motion(RigidStage stage, const std::function<void(std::span<RigidResponse>)>& respond) {
  constexpr int most_trials = 60;
  constexpr auto size = static_cast<std::size_t>(RigidResponse::size);
  std::vector<RigidSearch> searches;
  for (std::size_t r = 0; r < bodies_.size(); ++r) {
    const RigidState& s = state(static_cast<int>(r));
    Rigid& rigid = bodies_[r];
    searches.emplace_back(stage == RigidStage::end ? RigidVelocity{s.velocity, s.spin} : rigid.end);
    rigid.motion(stage) = searches.back().trial();
    rigid.found = rigid.driven;
  }
  const auto found = [&] { return std::ranges::all_of(bodies_, &Rigid::found); };
  for (int trial = 0; trial < most_trials && !found(); ++trial) {
    std::vector<RigidResponse> responses(bodies_.size());
    respond(responses);
    std::vector<ExactSum> sums;
    for (const RigidResponse& response : responses)
      sums.insert(sums.end(), std::begin(response.sums), std::end(response.sums));
    ranks_.sum(std::span<ExactSum>(sums));
    for (std::size_t r = 0; r < bodies_.size(); ++r) {
      Rigid& rigid = bodies_[r];
      if (rigid.found) continue;
      double values[size];
      for (std::size_t i = 0; i < size; ++i) values[i] = sums[size * r + i].value();
      const RigidState& s = state(static_cast<int>(r));
      RigidVelocity& motion = rigid.motion(stage);
      if (!rigid.meets_rigid) {
        searches[r].next(s, values);
        motion = searches[r].trial();
        rigid.found = searches[r].found();
        continue;
      }
      const RigidVelocity before = motion;
      motion = next_trial(s, searches[r].free(), before, values);
      const std::span<RigidContact> own = contacts_of(stage, r);
      for (RigidContact& contact : own) {
        contact.impulse = {};
        if (rigid.slips) contact.friction = 0;
      }
      if (!resolve_rigid_contacts(s, RigidResistance(s, values), motion, own)) fail_pressed(stage, r);
      rigid.found = same_motion(s, before, motion);
    }
  }
  return found();
}

}  // namespace mpm::core
