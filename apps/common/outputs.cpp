#include "apps/common/outputs.hpp"

#include <chrono>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "io/output/variables.hpp"

namespace mpm::apps {

namespace {

double wall() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string duration(double seconds) {
  if (!std::isfinite(seconds)) return "-";
  const auto s = static_cast<long>(seconds + 0.5);
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

/// Up to where a continued run keeps what its files hold. One that has nothing left to do writes its last
/// state again: it may have been killed before it could.
struct Kept {
  std::optional<std::int64_t> step;
  std::optional<double> time;
};

Kept kept_of(const std::optional<Continuation>& from, const core::Model& model) {
  if (!from) return {};
  const core::Clock& clock = model.clock;
  if (clock.time < model.scene->solution.end_time * (1 - 1e-12)) return {clock.step, clock.time};
  return {clock.step - 1, std::nextafter(clock.time, 0.0)};
}

}  // namespace

double Interval::passed(double now) const { return std::floor(now / every_ * (1 + 1e-12)); }

Outputs::Outputs(const std::string& folder, const core::Model& model, core::Exchange& exchange,
                 const std::optional<Continuation>& from, io::Log& log)
    : stem_(folder + "/" + model.scene->provenance.job_name),
      log_(log),
      status_(stem_ + ".sta", model, kept_of(from, model).step, exchange),
      report_(model.scene->output.console.print_time, model.clock.time),
      start_time_(model.clock.time),
      wall_start_(wall()),
      momentum_(model.scene->output.console.print_momentum) {
  const core::OutputInput& out = model.scene->output;
  if (!out.histories.empty()) {
    std::optional<io::HistoryFile::Continuation> history;
    if (from) history = {model.clock.step, from->tracked};
    history_.emplace(stem_ + "_curv.dat", model, history, exchange);
  }
  std::set<std::string> absent;
  const auto say_absent = [&](const std::vector<std::string>& names) {
    for (const std::string& notice : io::absence_notices(io::variables_of(names), model))
      absent.insert(notice);
  };
  for (const auto& history : out.histories) say_absent(history.variables);
  if (out.post_processing) say_absent(out.post_processing->variables);
  for (const std::string& notice : absent) log_.note("note       {}", notice);
  if (!out.post_processing) return;
  const core::PostProcessingInput& post = *out.post_processing;
  const auto variables = io::variables_of(post.variables);
  using Vtk = core::PostProcessingInput::Vtk;
  pictures_ = Interval(post.time_interval, model.clock.time);
  if (post.h5part) {
    h5part_.emplace(
        io::H5PartWriter::Settings{stem_ + ".h5part", variables, false, kept_of(from, model).time}, model,
        exchange);
    if (!h5part_->notice().empty()) log_.warn("{}", h5part_->notice());
  }
  if (post.vtk != Vtk::none) {
    vtu_.emplace(
        io::VtuWriter::Settings{folder, model.scene->provenance.job_name, post.vtk == Vtk::file_per_body,
                                variables, false, kept_of(from, model).time},
        model, exchange);
  }
}

std::vector<std::uint64_t> Outputs::tracked() const {
  return history_ ? history_->tracked() : std::vector<std::uint64_t>{};
}

void Outputs::write_pictures(const core::Model& model, core::Exchange& exchange) {
  if (h5part_) h5part_->write(model, exchange);
  if (vtu_) vtu_->write(model, exchange);
  if (history_) history_->flush(exchange);
  picture_step_ = model.clock.step;
}

void Outputs::after_step(const core::Model& model, core::Exchange& exchange) {
  const double before = wall();
  const double now = model.clock.time;
  if (history_) history_->add(model, exchange);
  if (model.clock.step == 0 || pictures_.due(now)) {
    write_pictures(model, exchange);
    pictures_.done(now);
  }
  seconds_ += wall() - before;
}

const core::Totals& Outputs::report(const core::Model& model, core::Exchange& exchange) {
  const double before = wall();
  totals_ = core::compute_totals(model, exchange);
  status_.add(model, totals_, exchange);
  const core::Clock& clock = model.clock;
  const double end = model.scene->solution.end_time;
  const core::EnergyBalance balance = core::energy_balance(totals_, model.initial_energy);
  if (report_step_ < 0) {
    log_.say("{:>9} {:>12} {:>10} {:>14} {:>14} {:>10} {:>9} {:>6} {:>8}", "step", "time", "dt", "kinetic",
             "internal", "drift", "particles", "done", "left");
  }
  const double part = (clock.time - start_time_) / (end - start_time_);
  const double left = part > 0 ? (wall() - wall_start_) * (1 - part) / part : std::nan("");
  log_.say("{:>9} {:>12.5g} {:>10.3g} {:>14.8g} {:>14.8g} {:>10.2e} {:>9} {:>5.1f}% {:>8}", clock.step,
           clock.time, clock.dt, totals_.kinetic, totals_.internal, balance.relative_drift, totals_.particles,
           100 * clock.time / end, duration(left));
  if (momentum_) {
    log_.say("{:>9} momentum {:.10g} {:.10g} {:.10g}", "", totals_.momentum.x, totals_.momentum.y,
             totals_.momentum.z);
  }
  log_.flush(exchange);
  report_.done(clock.time);
  report_step_ = clock.step;
  seconds_ += wall() - before;
  return totals_;
}

void Outputs::finish(const core::Model& model, core::Exchange& exchange) {
  if (report_step_ != model.clock.step) report(model, exchange);
  const double before = wall();
  if ((h5part_ || vtu_) && picture_step_ != model.clock.step) write_pictures(model, exchange);
  if (history_) history_->flush(exchange);
  seconds_ += wall() - before;
}

std::vector<std::string> Outputs::pictures() const {
  std::vector<std::string> files;
  if (h5part_) files.push_back(stem_ + ".h5part");
  if (vtu_) files.push_back(stem_ + ".pvd");
  return files;
}

}  // namespace mpm::apps
