#include "apps/common/run.hpp"

#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include "apps/common/case.hpp"
#include "apps/common/describe.hpp"
#include "apps/common/outputs.hpp"
#include "apps/common/resources.hpp"
#include "apps/common/stop.hpp"
#include "apps/common/watch.hpp"
#include "core/contact/overlaps.hpp"
#include "core/contact/rigid_bodies.hpp"
#include "core/setup/build_model.hpp"
#include "core/setup/prepare_model.hpp"
#include "core/simd/denormals.hpp"
#include "core/step/finite.hpp"
#include "core/step/stepper.hpp"
#include "io/output/file.hpp"
#include "io/output/job_lock.hpp"
#include "io/output/memory_use.hpp"
#include "io/output/particle_order.hpp"
#include "io/output/provenance.hpp"
#include "io/output/summary.hpp"
#include "io/restart/restart.hpp"
#include "parallel/communication.hpp"
#include "parallel/implicit/solver_library.hpp"
#include "parallel/mpi.hpp"
#include "physics/material/material.hpp"

namespace mpm::apps {

namespace {

/// Adds the bodies that the restart file does not have, with a note for each. Collective.
std::vector<std::string> add_new_bodies(core::Model& model, const std::vector<std::size_t>& numbers,
                                        core::Communication& communication) {
  std::vector<std::string> notices;
  if (numbers.empty()) return notices;
  core::add_bodies(model, numbers, communication);
  const core::Totals totals = core::compute_totals(model, communication);
  for (const std::size_t b : numbers) {
    notices.push_back(fmt::format(
        "body '{}' was not in the restart file: its {} particles are added now, as defined in the input",
        model.bodies[b].name, totals.bodies[b].particles));
  }
  return notices;
}

/// A sentence of the bodies of which nothing is left, whose mean places and velocities have no value; or
/// empty.
std::string words_of_emptied_bodies(const core::Model& model, const core::Totals& totals) {
  std::string words;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (totals.bodies[b].particles > 0) continue;
    words += fmt::format("{}body '{}' has no particles left: all of them have left the grid or were eroded",
                         words.empty() ? "" : "; ", model.bodies[b].name);
  }
  return words;
}

/// One run in its stages; the members are in the order of their construction.
class Run {
 public:
  Run(const RunOptions& options, const parallel::Communicator& world, const physics::Registry& registry)
      : options_(options), communication_(world), case_(load_case(options, world, registry.catalogue())) {
    core::flush_denormals_to_zero();
    threads_ = choose_threads(*case_.scene);
    start_threads(threads_, communication_.reductions);
    start_solver(world);
    core::check_decomposition(case_.scene->decomposition, communication_.reductions.size());
    model_ = core::prepare_model(case_.scene, physics::make_materials(*case_.scene, registry),
                                 io::columns_for(case_.scene->output));
    std::vector<std::string> notices;
    if (case_.restart) {
      const io::RestartResult state = io::read_restart(*case_.restart, model_, communication_);
      notices = state.notices;
      for (std::string& notice : add_new_bodies(model_, state.new_bodies, communication_))
        notices.push_back(std::move(notice));
      last_restart_ = *case_.restart;
      if (continues_files()) continuation_ = Continuation{state.extra.tracked, state.extra.marks};
    } else {
      core::build_model(model_, communication_);
    }
    // The input is checked completely before anything is written.
    open_log();
    if (newton_)
      log_->say(
          "implicit   results agree to the solver's tolerance on any ranks and threads; the same bits are "
          "promised for explicit steps alone");
    for (const std::string& notice : notices) log_->warn("{}", notice);
    if (case_.restart)
      log_->say("continue   from {} at step {}, time {:.6g}", *case_.restart, model_.clock.step,
                model_.clock.time);
    if (case_.restart && options_.restart_input)
      log_->say(
          "note       particles keep their state: geometry, initial velocities, E0, random failure "
          "thresholds and initial porosity of the new input act on bodies alone that the restart file does "
          "not have");
    stepper_.emplace(model_, communication_);
    describe(model_, *stepper_, communication_.reductions, threads_, *log_);
    warn_of_long_step(model_, *log_);
    for (const std::string& law : registry.added()) log_->note("law        {}, added by this program", law);
    for (const core::Diagnostic& note : case_.notes) log_->say("{}", to_line(note));
    if (!case_.restart) {
      say_thermal_pressures(model_, communication_, *log_);
      for (const std::string& shared : core::shared_places_in_words(model_, communication_.reductions))
        log_->warn("{}", shared);
    }
    if (case_.restart && !(model_.clock.time < case_.scene->solution.end_time))
      log_->warn("EndTime {:.6g} is not after the time of the restart file, {:.6g}: there is no step to do",
                 case_.scene->solution.end_time, model_.clock.time);
    if (!case_.restart && case_.scene->contact.enable) {
      for (const std::string& overlap : core::overlaps_in_words(model_, communication_))
        log_->warn("{}", overlap);
      for (const std::string& part : core::rigid_parts_in_words(model_)) log_->say("note       {}", part);
    }
    setup_seconds_ = clock_.seconds();
  }

  ExitCode go() {
    if (options_.dry_run) {
      log_->flush(communication_);
      return done;
    }
    outputs_.emplace(options_.output_dir, model_, communication_, continuation_, *log_);
    watch_.emplace(*case_.scene, model_.clock.time);
    restart_ = Interval(case_.scene->output.restart_interval.value_or(0), model_.clock.time);
    const double loop_start = clock_.seconds();
    ExitCode code = done;
    std::string status = "completed", reason;
    try {
      reason = loop();
      if (!reason.empty()) {
        status = "stopped";
        code = status_rows_reached() ? done : stopped_early;
      }
      if (code == stopped_early) save();
      outputs_->finish(model_, communication_);
    } catch (const parallel::WrongSolverOptions& wrong) {
      status = "failed";
      reason = wrong.what();
      code = input_error;
    } catch (const core::NumericalFailure& failure) {
      status = "failed";
      reason = failure.what();
      code = numerical_failure;
      if (failure.keeps_state()) save_after_failure();
    } catch (const io::FileError& failure) {
      status = "failed";
      reason = failure.what();
      code = file_error;
    }
    const double loop_seconds = clock_.seconds() - loop_start;
    conclude(status, reason, loop_seconds);
    return code;
  }

 private:
  /// The solver of implicit steps, where the scene has them. Collective.
  void start_solver(const parallel::Communicator& world) {
    const core::SolutionInput& solution = case_.scene->solution;
    if (solution.integration != core::Integration::implicit) {
      if (!options_.solver_options.empty())
        throw core::InputErrors(
            core::SourceLocation{options_.job, 0}, options_.solver_options.front(),
            "options after -- are for PETSc, which only implicit steps use: remove them, or set "
            "Solution@Integration to impl");
      return;
    }
    require_newton_solver(*case_.scene);
    newton_ = parallel::make_newton_solver(world, solution.implicit.value_or(core::ImplicitInput{}),
                                           options_.solver_options);
    communication_.newton = newton_.get();
  }
  /// Takes the job lock: from here on the files of the job belong to this run.
  void open_log() {
    io::together(communication_, [&] {
      if (communication_.reductions.rank() == 0) io::make_folder(options_.output_dir);
    });
    bool elsewhere = false;
    std::string cut;
    std::vector<std::string> superseded;
    if (!options_.dry_run) {
      lock_.emplace(file(".lock"), communication_);
      if (communication_.reductions.any(parallel::launcher_ended())) {
        // Ranks that outlive a killed mpirun end soon, and may have waited for the run that followed theirs.
        lock_->release(communication_.reductions);
        io::together(communication_, [] {
          throw io::FileError("the run was not started: the mpirun that started its ranks has ended");
        });
      }
      elsewhere = continuation_ && goes_on_elsewhere() &&
                  forget_what_is_elsewhere(file(""), *continuation_, communication_);
      io::together(communication_, [&] {
        if (communication_.reductions.rank() != 0) return;
        io::remove_file(
            file(".summary.json"));  // of an earlier run, in case this one ends before writing its own
        superseded =
            io::set_aside_superseded(options_.output_dir, case_.scene->provenance.job_name, case_.restart);
        if (continuation_) cut = log_notice(file(".out"), *continuation_);
      });
    }
    log_.emplace(file(".out"), continues_files() || options_.dry_run, true, communication_);
    for (const auto& [name, value] : io::provenance_of(*case_.scene)) log_->note("{:<10} {}", name, value);
    if (lock_ && !lock_->notice().empty()) log_->note("note       {}", lock_->notice());
    for (const std::string& path : superseded)
      log_->note(
          "note       a restart file of an earlier run, later than the start of this one, has been renamed "
          "to {}",
          path);
    if (!cut.empty()) log_->warn("{}", cut);
    if (elsewhere)
      log_->note("note       some files of the earlier run are missing in this folder: new ones are started");
  }

  bool goes_on_elsewhere() {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path folder = fs::path(*case_.restart).parent_path();
    return communication_.reductions.any(
        communication_.reductions.rank() == 0 &&
        !fs::equivalent(folder.empty() ? "." : folder, options_.output_dir, error));
  }

  /// `folder/Job<ending>`
  std::string file(const std::string& ending) const {
    return options_.output_dir + "/" + case_.scene->provenance.job_name + ending;
  }

  /// A restart continues the job's own files; with the input of another job (-rt) it writes under the name of
  /// that job.
  bool continues_files() const {
    return case_.restart && !options_.dry_run &&
           (!options_.restart_input || case_.restart_job == case_.scene->provenance.job_name);
  }

  bool status_rows_reached() const {
    return options_.status_rows && outputs_->status_rows() >= *options_.status_rows;
  }

  /// Runs to the end or until a stop is requested; returns the reason.
  std::string loop() {
    if (!case_.restart) {
      outputs_->after_step(model_, communication_);
      outputs_->report(model_, communication_);
    }
    const double end = case_.scene->solution.end_time;
    while (model_.clock.time < end * (1 - 1e-12)) {
      if (noted_signal() != 0 || (options_.max_wall_time && clock_.seconds() > *options_.max_wall_time)) {
        stepper_->request_stop();
      }
      stepper_->step();
      if (const std::string words = stepper_->words_of_step(); !words.empty())
        log_->note("implicit   {}", words);
      if (!stepper_->words_of_change().empty()) log_->say("scheme     {}", stepper_->words_of_change());
      particle_steps_ += static_cast<double>(model_.local_particles());
      watch_->after_step(model_, stepper_->incidents(), communication_, *log_);
      outputs_->after_step(model_, communication_);
      if (outputs_->report_due(model_)) note_balance(outputs_->report(model_, communication_));
      if (restart_.due(model_.clock.time)) {
        save();
        restart_.done(model_.clock.time);
      }
      if (stepper_->stopping())
        return noted_signal() != 0 ? fmt::format("signal {}", noted_signal())
                                   : "stop requested by a signal or --max-wall-time";
      if (status_rows_reached()) return fmt::format("{} rows in the .sta file", outputs_->status_rows());
      if (watch_->near_boundary(model_, communication_))
        return "a particle is next to an open boundary of the grid";
    }
    return {};
  }

  void note_balance(const core::Totals& totals) {
    watch_->note_balance(model_.clock, core::energy_balance(totals, model_.initial_energy), *log_);
  }

  void save() {
    const io::RestartExtra extra{case_.bytes, outputs_->tracked(), outputs_->marks(communication_)};
    const double before = clock_.seconds();
    core::require_finite(model_, communication_);
    const std::string path = io::write_restart(options_.output_dir, case_.scene->provenance.job_name, model_,
                                               extra, communication_);
    log_->say("restart    {} at step {}, time {:.6g}", path, model_.clock.step, model_.clock.time);
    last_restart_ = path;
    save_seconds_ += clock_.seconds() - before;
  }

  /// A disk error then must not hide why the run stopped, nor keep the summary from being written.
  void save_after_failure() {
    try {
      save();
    } catch (const io::FileError& failure) {
      log_->warn("the last good state was not saved: {}", failure.what());
    }
  }

  void conclude(const std::string& status, const std::string& reason, double loop_seconds) {
    io::RunReport report;
    report.status = status;
    report.reason = reason;
    report.threads = threads_;
    report.seconds_total = clock_.seconds();
    report.seconds_setup = setup_seconds_;
    report.seconds_loop = loop_seconds;
    report.output = communication_.reductions.spread(outputs_->seconds() + save_seconds_);
    for (const core::Phase& p : stepper_->phases())
      report.phases.emplace_back(p.name, communication_.reductions.spread(p.seconds));
    for (const core::PartOfPhase& p : stepper_->parts())
      report.parts.push_back({p.phase, p.name, communication_.reductions.spread(p.seconds)});
    report.particle_steps =
        communication_.reductions.spread(particle_steps_).mean * communication_.reductions.size();
    const core::Totals totals = core::compute_totals(model_, communication_);
    if (status != "failed" && watch_->last_noted_step() < model_.clock.step) note_balance(totals);
    if (report.reason.empty()) report.reason = watch_->words_of_drift();
    const std::string emptied = words_of_emptied_bodies(model_, totals);
    log_->say("\n{}", io::timing_table(report));
    if (const std::string words = stepper_->words_of_run(); !words.empty()) log_->say("implicit   {}", words);
    log_->say(
        "state      {:016x} is the hash of all particles; {}", io::state_hash(model_, communication_),
        newton_ ? "implicit steps promise the solver's tolerance on any ranks and threads, not the same bits"
                : "the same on any ranks and threads");
    if (totals.left_grid > 0 || totals.eroded > 0) {
      log_->say(
          "{} particle(s) left the grid, {} eroded; mass {:.6g} with kinetic energy {:.6g} and internal "
          "energy {:.6g} were removed with them",
          totals.left_grid, totals.eroded, totals.removed_mass, totals.removed_kinetic,
          totals.removed_internal);
    }
    if (!emptied.empty()) log_->say("note       {}", emptied);
    say_what_was_counted(model_, communication_.reductions, *log_);
    say_large_strains(model_, communication_.reductions, *log_);
    watch_->conclude(*log_);
    if (status == "failed") {
      log_->say("FAILED     {}", reason);
      if (!last_restart_.empty()) log_->say("           the last good state is in {}", last_restart_);
      if (communication_.reductions.rank() == 0) std::fprintf(stderr, "%s\n", reason.c_str());
    } else if (status == "stopped") {
      log_->say("stopped    {}", reason);
    } else {
      log_->say("completed  in {:.2f} s", report.seconds_total);
    }
    for (const std::string& picture : outputs_->pictures()) log_->say("open       {}", picture);
    try {
      io::write_summary(file(".summary.json"), model_, totals, report, communication_);
      log_->sync(communication_);
      lock_->release(communication_);
    } catch (const io::FileError&) {
      if (status != "failed") throw;  // else the disk error that ended the run also prevents the summary
    }
  }

  RunOptions options_;
  WallClock clock_;
  std::unique_ptr<core::NewtonSolver> newton_;
  parallel::MpiCommunication communication_;
  Case case_;
  int threads_ = 1;
  std::optional<io::JobLock> lock_;
  std::optional<io::Log> log_;
  core::Model model_;
  std::optional<Continuation> continuation_;
  std::optional<core::Stepper> stepper_;
  std::optional<Outputs> outputs_;
  std::optional<Watch> watch_;
  Interval restart_;
  std::string last_restart_;
  double setup_seconds_ = 0;
  double save_seconds_ = 0;
  double particle_steps_ = 0;
};

/// Options of a run have no effect where -h5pt only converts a file. Throws InputErrors.
void refuse_with_conversion(const RunOptions& options) {
  std::vector<core::Diagnostic> faults;
  const auto refuse = [&](bool given, const char* option, const char* why) {
    if (given) faults.push_back({options.job, 0, option, {}, {}, why});
  };
  refuse(options.dry_run, "--dry-run",
         "does not go with -h5pt, which converts a file and runs nothing: omit one");
  refuse(options.status_rows.has_value(), "-nsteps",
         "has no effect with -h5pt, which runs no steps: omit it");
  refuse(options.max_wall_time.has_value(), "--max-wall-time",
         "has no effect with -h5pt, which runs no steps: omit it");
  if (!faults.empty()) throw core::InputErrors(faults);
}

}  // namespace

ExitCode run(const RunOptions& options, const parallel::Communicator& world,
             const physics::Registry& registry) {
  if (options.lsdyna) {
    throw core::InputErrors(
        core::SourceLocation{options.job, 0}, "-lsdyna",
        "known, but not implemented yet: omit the option; .h5part and .vtu files hold the particles");
  }
  if (options.to_h5part) {
    refuse_with_conversion(options);
    return convert_restart(options, world, registry.catalogue());
  }
  if (!options.dry_run) watch_signals();
  return Run(options, world, registry).go();
}

}  // namespace mpm::apps
