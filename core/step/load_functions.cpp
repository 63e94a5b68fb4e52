#include "core/step/load_functions.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <omp.h>

namespace mpm::core {

namespace {

PlaceAndTime particle_at(const ColumnLayout& layout, const double* lane, double time) {
  PlaceAndTime at;
  at.time = time;
  for (int a = 0; a < 3; ++a) {
    at.place[a] = lane[layout.offset(next(Column::position_x, a))];
    const Column first = next(Column::first_x, a);
    if (layout.has(first)) at.first_place[a] = lane[layout.offset(first)];
  }
  return at;
}

std::string particle_in_words(const Body& body, const double* lane, const PlaceAndTime& at) {
  if (lane == nullptr) return fmt::format("every particle of body \"{}\"", body.name);
  return fmt::format("particle {:.0f} of body \"{}\" at ({:.6g}, {:.6g}, {:.6g})",
                     lane[body.pool->layout().offset(Column::identity)], body.name, at.place.x, at.place.y,
                     at.place.z);
}

}  // namespace

LoadFunctions::LoadFunctions() : threads_(static_cast<std::size_t>(omp_get_max_threads())) {}

LoadFunctions::Terms LoadFunctions::add(const Expressions& expressions) {
  Terms terms;
  for (const Expression& e : expressions) {
    Term term{&e, 0, Formula::check(e.text).uses};
    const auto known = std::ranges::find(texts_, e.text);
    term.formula = static_cast<std::size_t>(known - texts_.begin());
    if (known == texts_.end()) {
      texts_.push_back(e.text);
      for (OfThread& thread : threads_) thread.formulas.emplace_back(e.text);
    }
    const bool of_time = (term.uses & ~variables_named("t")).none();
    (of_time ? terms.of_time : terms.of_place).push_back(term);
  }
  return terms;
}

LoadFunctions::OfThread& LoadFunctions::mine() {
  return threads_[static_cast<std::size_t>(omp_get_thread_num())];
}

/// `lane` is null for an expression of time alone.
double LoadFunctions::evaluate(OfThread& mine, const Term& term, const Body& body, const double* lane,
                               const PlaceAndTime& at) {
  const double value = mine.formulas[term.formula](at);
  if (std::isfinite(value)) return value;
  const double identity = lane == nullptr ? -1 : lane[body.pool->layout().offset(Column::identity)];
  mine.fault.offer(identity, [&] {
    return fmt::format("{} is {} for {}, t = {:.9g}: give an expression that is finite there",
                       in_words(*term.input), not_finite_in_words(value), particle_in_words(body, lane, at),
                       at.time);
  });
  return 0;
}

void LoadFunctions::add_values(const std::vector<Term>& of_time, const Body& body, double time,
                               double* components) {
  PlaceAndTime at;
  at.time = time;
  for (const Term& term : of_time)
    components[term.input->component] += evaluate(threads_.front(), term, body, nullptr, at);
}

void LoadFunctions::add_values(const std::vector<Term>& of_place, const Body& body, const double* lane,
                               double time, double* components) {
  const PlaceAndTime at = particle_at(body.pool->layout(), lane, time);
  OfThread& mine = this->mine();
  for (const Term& term : of_place) components[term.input->component] += evaluate(mine, term, body, lane, at);
}

double LoadFunctions::slope(const Term& term, const Body& body, const double* lane, double time, int axis,
                            double step) {
  if (!term.uses[static_cast<std::size_t>(axis)]) return 0;
  PlaceAndTime below = particle_at(body.pool->layout(), lane, time), above = below;
  below.place[axis] -= step;
  above.place[axis] += step;
  OfThread& mine = this->mine();
  return (evaluate(mine, term, body, lane, above) - evaluate(mine, term, body, lane, below)) /
         (above.place[axis] - below.place[axis]);
}

OffendingParticle LoadFunctions::take_fault() {
  OffendingParticle first;
  for (OfThread& thread : threads_) {
    if (!thread.fault.empty()) first.offer(thread.fault.identity, [&] { return thread.fault.words; });
    thread.fault = {};
  }
  return first;
}

}  // namespace mpm::core
