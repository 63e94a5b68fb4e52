#include "core/step/stepper.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/step/finite.hpp"
#include "core/step/scheme_change.hpp"

namespace mpm::core {

namespace {

/// A run whose step falls below this fraction of the first one would not finish.
constexpr double smallest_step_ratio = 1e-7;

}  // namespace

Stepper::Stepper(Model& model, Communication& communication)
    : model_(model),
      communication_(communication),
      integrator_(make_integrator(model, communication)),
      migration_(model, communication),
      phases_(make_phases()) {}

std::vector<Phase> Stepper::make_phases() {
  std::vector<Phase> step{{"choose time step", [this] { choose_time_step(); }}};
  for (Phase& phase : integrator_->phases()) step.push_back(std::move(phase));
  step.push_back({"collect departing particles", [this] { migration_.collect(integrator_->departing()); }});
  step.push_back({"reduce status", [this] { reduce_status(); }});
  step.push_back({"migrate", [this] { migration_.deliver(needs_bricks_); }});
  step.push_back({"sort and prune", [this] {
                    // Next to the solution of an implicit step's equations this costs nothing, and particles
                    // that are sorted are assembled cell by cell.
                    const bool implicit = model_.scene->solution.integration == Integration::implicit;
                    if (implicit || model_.clock.step % sorting_interval == 0) migration_.sort_and_prune();
                  }});
  if (may_change_scheme(*model_.scene))
    step.push_back(
        {"energy balance", [this] { drift_ = drift_beyond_tolerance(model_, communication_.reductions); }});
  return step;
}

void Stepper::step() {
  using clock = std::chrono::steady_clock;
  words_of_change_.clear();
  auto before = clock::now();
  for (Phase& phase : phases_) {
    if (!phase.run) break;
    phase.run();
    const auto now = clock::now();
    phase.seconds += std::chrono::duration<double>(now - before).count();
    before = now;
  }
  if (!failure_.empty()) throw NumericalFailure(failure_);
  if (collapsed_) fail_collapsed();
  if (drift_ && model_.clock.time < model_.scene->solution.end_time) go_on_with_usavg();
}

void Stepper::go_on_with_usavg() {
  const Clock& clock = model_.clock;
  words_of_change_ = fmt::format(
      "step {}, time {:.6g}: the energy balance is off by {:.2g} %{}: the run goes on with USAVG, which "
      "keeps it and whose steps take up to 1.8 times as long; algorithm=\"MUSL\" prevents this",
      clock.step, clock.time, 100 * *drift_,
      clock.step > long_run ? fmt::format(", after {:.2g} % at step {}", 100 * clock.looks.early, long_run)
                            : "");
  drift_.reset();
  change_scheme(model_, Scheme::usavg);
  integrator_ = make_integrator(model_, communication_);
  std::vector<Phase> before = std::exchange(phases_, make_phases());
  for (Phase& phase : before) {
    const auto same = std::ranges::find(phases_, phase.name, &Phase::name);
    if (same != phases_.end())
      same->seconds += phase.seconds;
    else
      phases_.push_back({phase.name, {}, phase.seconds});
  }
}

void Stepper::fail_collapsed() {
  const Clock& clock = model_.clock;
  const std::string fastest = fastest_in_words(model_, communication_),
                    hottest = hottest_in_words(model_, communication_);
  throw NumericalFailure(fmt::format(
      "step {}, time {:.9g}: the critical time step has fallen to {:.3g}, {:.1g} of the first one; the "
      "fastest: {}; the hottest: {}",
      clock.step, clock.time, clock.critical_dt, clock.critical_dt / clock.first_critical_dt, fastest,
      hottest));
}

void Stepper::choose_time_step() {
  Clock& clock = model_.clock;
  // The last step ends at EndTime.
  const double dt = std::min(integrator_->next_step(clock), model_.scene->solution.end_time - clock.time);
  if (!(clock.time + dt > clock.time)) {
    throw NumericalFailure(fmt::format(
        "step {}, time {:.9g}: a time step of {:.3g} does not advance the time any more; the fastest: {}",
        clock.step + 1, clock.time, dt, fastest_in_words(model_, communication_)));
  }
  clock.dt = dt;
  integrator_->begin_step(dt);
}

void Stepper::reduce_status() {
  Clock& clock = model_.clock;
  Ledger& ledger = model_.ledger;
  const StepStatistics found = integrator_->take_statistics();
  ledger.external_work += found.work;
  ledger.internal_lead = found.internal_lead;
  if (model_.scene->contact.enable) ledger.contact += found.contact;
  for (std::size_t r = 0; r < model_.reactions.size(); ++r)
    model_.reactions[r].since_start.add_step(r < found.reactions.size() ? found.reactions[r]
                                                                        : ReactionSums{});
  ledger.velocity_limited += found.limited;
  ledger.wide_domains += found.domains.wide;
  ledger.tangled_domains += found.domains.tangled;
  ledger.events += found.events;
  ledger.failed += found.events.failed;
  incidents_ = {found.events, found.vanishing, found.negative, migration_.left_now(),
                migration_.first_left()};

  const bool failed = found.events.not_finite > 0 || !migration_.fault().empty() ||
                      !found.undefined.empty() || !found.overlap.empty();
  const StepStatus all = communication_.reductions.combine(
      {integrator_->stable_step(found), migration_.wants_new_bricks(), failed, stop_requested_});
  ++clock.step;
  clock.time += clock.dt;
  clock.critical_dt = all.stable_step;
  needs_bricks_ = all.needs_bricks;
  stopping_ = all.stop;

  std::string what;
  if (all.failed) what = first_of_all(communication_, found.undefined).words;
  if (all.failed && what.empty()) what = first_of_all(communication_, found.overlap).words;
  if (all.failed && what.empty()) {
    OffendingParticle mine = migration_.fault();
    if (found.events.not_finite > 0) {
      const OffendingParticle lost = first_not_finite(model_);
      if (!lost.empty()) mine.offer(lost.identity, [&] { return lost.words; });
    }
    what = first_of_all(communication_, mine).words;
    if (what.empty()) what = "a particle in migration has a state that is not finite";
  } else if (std::isfinite(clock.first_critical_dt) &&
             clock.critical_dt < smallest_step_ratio * clock.first_critical_dt) {
    collapsed_ = true;  // said in step(), once the particles that change bricks have arrived
  }
  if (!what.empty()) failure_ = fmt::format("step {}, time {:.9g}: {}", clock.step, clock.time, what);
}

}  // namespace mpm::core
