#include "apps/common/outputs.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "core/step/finite.hpp"
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

// Suffixes of the file names; restart files use them as keys of the marks.
constexpr const char* status_ending = ".sta";
constexpr const char* history_ending = "_curv.dat";
constexpr const char* h5part_ending = ".h5part";
constexpr const char* vtu_ending = ".pvd";
constexpr const char* log_ending = ".out";

std::string mark_named(const Continuation& from, const std::string& name) {
  const auto found = from.marks.find(name);
  return found == from.marks.end() ? std::string() : found->second;
}

io::TableContinuation table_from(const Continuation& from, const std::string& name, std::int64_t last_step) {
  return {last_step, io::TableMark::from(mark_named(from, name))};
}

/// The last row of .sta that a continued run keeps. A run with no steps left writes its last row again, since
/// it may have been killed before writing it.
std::int64_t last_status_step(const core::Model& model) {
  const core::Clock& clock = model.clock;
  const bool over = clock.time >= model.scene->solution.end_time * (1 - 1e-12);
  return over ? clock.step - 1 : clock.step;
}

std::optional<io::TableContinuation> status_from(const std::optional<Continuation>& from,
                                                 const core::Model& model) {
  if (!from) return {};
  return table_from(*from, status_ending, last_status_step(model));
}

std::optional<std::string> picture_from(const std::optional<Continuation>& from, const std::string& name) {
  return from ? std::optional(mark_named(*from, name)) : std::nullopt;
}

/// With histories the file has a row for every step; without, one for each row of .sta.
std::optional<io::HistoryFile::Continuation> history_from(const std::optional<Continuation>& from,
                                                          const core::Model& model) {
  if (!from) return {};
  const bool each_step = !model.scene->output.histories.empty();
  const std::int64_t last_step = each_step ? model.clock.step : last_status_step(model);
  return io::HistoryFile::Continuation{table_from(*from, history_ending, last_step), from->tracked};
}

}  // namespace

bool forget_what_is_elsewhere(const std::string& stem, Continuation& from, core::Reductions& ranks) {
  return std::erase_if(from.marks, [&](const auto& mark) {
           return !ranks.any(ranks.rank() == 0 && std::filesystem::exists(stem + mark.first));
         }) > 0;
}

std::string log_notice(const std::string& path, const Continuation& from) {
  const std::string expected = mark_named(from, log_ending);
  if (expected.empty()) return {};
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) return fmt::format("'{}' is missing; it had {} bytes: a new file is started", path, expected);
  if (bytes >= std::strtoull(expected.c_str(), nullptr, 10)) return {};
  return fmt::format(
      "'{}' has {} bytes, but had {} when the restart file was written: the missing part is lost", path,
      bytes, expected);
}

double Interval::passed(double now) const { return std::floor(now / every_ * (1 + 1e-12)); }

Outputs::Outputs(const std::string& folder, const core::Model& model, core::Reductions& ranks,
                 const std::optional<Continuation>& from, io::Log& log)
    : stem_(folder + "/" + model.scene->provenance.job_name),
      log_(log),
      status_(stem_ + status_ending, model, status_from(from, model), ranks),
      history_(stem_ + history_ending, model, history_from(from, model), ranks),
      report_(model.scene->output.console.print_time, model.clock.time),
      start_time_(model.clock.time),
      wall_start_(wall()),
      momentum_(model.scene->output.console.print_momentum) {
  if (from) status_.recall(mark_named(*from, status_ending));
  const core::OutputInput& out = model.scene->output;
  std::set<std::string> absent;
  const auto say_absent = [&](const std::vector<std::string>& names) {
    for (const std::string& notice : io::absence_notices(io::variables_of(names), model))
      absent.insert(notice);
  };
  for (const auto& history : out.histories) say_absent(history.variables);
  if (out.post_processing) say_absent(out.post_processing->variables);
  for (const std::string& notice : absent) log_.note("note       {}", notice);
  for (const std::string& chosen : history_.chosen_late()) log_.note("note       {}", chosen);
  for (const std::string& chosen : history_.chosen_far()) log_.say("note       {}", chosen);
  open_pictures(folder, model, ranks, from);
  say_notices();
}

void Outputs::open_pictures(const std::string& folder, const core::Model& model, core::Reductions& ranks,
                            const std::optional<Continuation>& from) {
  const core::OutputInput& out = model.scene->output;
  if (!out.post_processing) return;
  const core::PostProcessingInput& post = *out.post_processing;
  const auto variables = io::variables_of(post.variables);
  using Vtk = core::PostProcessingInput::Vtk;
  pictures_ = Interval(post.time_interval, model.clock.time);
  if (post.h5part) {
    h5part_.emplace(io::H5PartWriter::Settings{stem_ + h5part_ending, variables, false,
                                               picture_from(from, h5part_ending)},
                    model, ranks);
  }
  if (post.vtk != Vtk::none) {
    vtu_.emplace(
        io::VtuWriter::Settings{folder, model.scene->provenance.job_name, post.vtk == Vtk::file_per_body,
                                variables, false, picture_from(from, vtu_ending)},
        model, ranks);
  }
}

std::vector<std::uint64_t> Outputs::tracked() const { return history_.tracked(); }

void Outputs::say_notices() {
  std::vector<std::string> notices{status_.notice(), history_.notice()};
  if (h5part_) notices.push_back(h5part_->notice());
  if (vtu_) notices.push_back(vtu_->notice());
  for (const std::string& notice : notices) {
    if (!notice.empty()) log_.warn("{}", notice);
  }
}

std::map<std::string, std::string> Outputs::marks(core::Reductions& ranks) {
  const double before = wall();
  std::map<std::string, std::string> marks;
  status_.sync(ranks);
  marks[status_ending] = status_.mark();
  history_.sync(ranks);
  marks[history_ending] = history_.mark().text();
  if (h5part_) marks[h5part_ending] = h5part_->mark(ranks);
  if (vtu_) {
    vtu_->sync(ranks);
    marks[vtu_ending] = vtu_->mark();
  }
  log_.sync(ranks);
  marks[log_ending] = std::to_string(log_.bytes());
  seconds_ += wall() - before;
  return marks;
}

void Outputs::write_pictures(const core::Model& model, core::Reductions& ranks) {
  const std::int64_t step = model.clock.step;
  const auto write = [&](auto& pictures) {
    if (!pictures || pictures->last_step() == step) return;
    core::require_finite(model, ranks);
    pictures->write(model, ranks);
    if (!pictures->warning().empty()) log_.warn("{}", pictures->warning());
  };
  write(h5part_);
  write(vtu_);
  history_.flush(ranks);
}

void Outputs::after_step(const core::Model& model, core::Reductions& ranks) {
  const double before = wall();
  const double now = model.clock.time;
  if (history_.each_step()) {
    history_.add(model, ranks);
    for (const std::string& gone : history_.gone()) log_.note("note       {}", gone);
  }
  if (model.clock.step == 0 || pictures_.due(now)) {
    write_pictures(model, ranks);
    pictures_.done(now);
  }
  seconds_ += wall() - before;
}

const core::Totals& Outputs::report(const core::Model& model, core::Reductions& ranks) {
  const double before = wall();
  totals_ = core::compute_totals(model, ranks);
  const core::EnergyBalance balance = core::energy_balance(totals_, model.initial_energy);
  core::require_finite(
      model,
      std::array{totals_.kinetic, totals_.internal, totals_.external_work, totals_.momentum.x,
                 totals_.momentum.y, totals_.momentum.z, balance.total, balance.relative_drift},
      ranks);
  status_.add(model, totals_, ranks);
  if (!history_.each_step()) {
    history_.add(model, {totals_.kinetic, totals_.internal}, ranks);
    history_.flush(ranks);
  }
  const core::Clock& clock = model.clock;
  const double end = model.scene->solution.end_time;
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
  log_.flush(ranks);
  report_.done(clock.time);
  report_step_ = clock.step;
  seconds_ += wall() - before;
  return totals_;
}

void Outputs::finish(const core::Model& model, core::Reductions& ranks) {
  if (report_step_ != model.clock.step) report(model, ranks);
  const double before = wall();
  write_pictures(model, ranks);
  if (h5part_) h5part_->finish(ranks);
  if (vtu_) vtu_->sync(ranks);
  status_.sync(ranks);
  history_.sync(ranks);
  const auto say_cut = [&](const auto& pictures, const char* ending) {
    const std::string text = pictures ? pictures->cut_values().total(stem_ + ending) : std::string();
    if (!text.empty()) log_.say("counted    {}", text);
  };
  say_cut(h5part_, h5part_ending);
  say_cut(vtu_, vtu_ending);
  seconds_ += wall() - before;
}

std::vector<std::string> Outputs::pictures() const {
  std::vector<std::string> files;
  if (h5part_) files.push_back(stem_ + h5part_ending);
  if (vtu_) files.push_back(stem_ + vtu_ending);
  return files;
}

}  // namespace mpm::apps
