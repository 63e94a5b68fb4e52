#include "apps/common/describe.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/particle_range.hpp"
#include "core/setup/memory.hpp"
#include "core/step/load_areas.hpp"
#include "core/step/scheme_change.hpp"

namespace mpm::apps {

namespace {

constexpr std::size_t most_lines = 100;

std::string bytes_in_words(double bytes) {
  return bytes < 1e6   ? fmt::format("{:.1f} kB", bytes / 1e3)
         : bytes < 1e9 ? fmt::format("{:.1f} MB", bytes / 1e6)
                       : fmt::format("{:.2f} GB", bytes / 1e9);
}

/// A line for each material of the bodies: waves far from what is known of it show a wrong unit.
void describe_materials(const core::Model& model, io::Log& log) {
  std::vector<const core::ConstitutiveModel*> said;
  for (const core::Body& body : model.bodies) {
    const core::ConstitutiveModel* material = body.model;
    if (said.size() == most_lines || std::ranges::find(said, material) != said.end()) continue;
    said.push_back(material);
    const double waves = material->initial_sound_speed();
    log.say("material   \"{}\": density {:.6g}, {}", material->name(), material->reference_density(),
            waves > 0 ? fmt::format("speed of waves at rest {:.4g}", waves) : "rigid");
  }
}

/// A line for each body, up to a maximum.
void describe_bodies(const core::Model& model, io::Log& log) {
  const int common = core::ColumnSet::mechanics().size();
  for (std::size_t b = 0; b < std::min(model.bodies.size(), most_lines); ++b) {
    const core::Body& body = model.bodies[b];
    const core::ColumnLayout& layout = body.pool->layout();
    std::string more;
    for (int c = common; c < core::column_count; ++c) {
      if (layout.has(static_cast<core::Column>(c)))
        more += fmt::format(" {}", core::name_of(static_cast<core::Column>(c)));
    }
    log.say("body       \"{}\" of \"{}\": {} bytes per particle{}{}", body.name, body.model->name(),
            layout.bytes_per_particle(), more.empty() ? "" : ", beyond the mechanics", more);
  }
  if (model.bodies.size() > most_lines)
    log.say("body       {} more bodies", model.bodies.size() - most_lines);
}

constexpr char axes[] = "xyz";

/// The area along the normal, where a part of the box's cross-sections remains.
double area_along(const core::LoadArea& area, int normal) {
  const double net = area.net()[normal];
  constexpr double rounding = 1e-9;
  return std::abs(net) > rounding * (area.lower[normal] + area.upper[normal]) ? net : 0;
}

/// Empty for a load that acts.
std::string why_idle(const core::LoadArea& area) {
  if (!area.reached) return "no particle of the body is in its box";
  const int normal = area.load->normal;
  if (normal < 0 || area.load->pressure != 0 || !area.crossed || area_along(area, normal) != 0) return {};
  return fmt::format(
      "no surface with the normal +{0} or -{0} is in its box; one of the box's faces belongs outside of the "
      "body, at least half a ramp from the loaded surface",
      axes[normal]);
}

std::string words_of_area(const core::LoadArea& area) {
  const core::SurfaceLoad& load = *area.load;
  std::string words;
  if (load.normal >= 0) {
    const double along = area_along(area, load.normal);
    words = along == 0 ? fmt::format(
                             "acts on surfaces with the normals +{0} and -{0} in opposite directions, "
                             "without a total force",
                             axes[load.normal])
                       : fmt::format("acts on the area {:.4g} with the normal {}{}", std::abs(along),
                                     along > 0 ? '+' : '-', axes[load.normal]);
  }
  if (load.normal >= 0 && load.pressure == 0) return words;
  const double x = area_along(area, 0), y = area_along(area, 1), z = area_along(area, 2);
  return fmt::format("{}{}has its pressure on the sum of area vectors ({:.4g}, {:.4g}, {:.4g})", words,
                     words.empty() ? "" : "; ", x, y, z);
}

/// A line for each load of a surface, up to a maximum; a warning where it does nothing. Collective.
void describe_loads(const core::Model& model, core::Reductions& ranks, io::Log& log) {
  std::size_t said = 0;
  for (const core::LoadArea& area : core::load_areas(model, ranks)) {
    // A pressure on the whole surface needs no words.
    const bool everywhere = area.lower == core::Vec3<double>{} && area.upper == core::Vec3<double>{} &&
                            !area.crossed && area.reached;
    if (area.load->normal < 0 && everywhere) continue;
    if (said++ == most_lines) return log.say("load       more loads");
    const std::string& body = model.bodies[area.body].name;
    if (const std::string why = why_idle(area); !why.empty())
      log.warn("Traction {} of body \"{}\" has no effect: {}", area.number, body, why);
    else
      log.say("load       Traction {} of \"{}\" {}", area.number, body, words_of_area(area));
  }
}

}  // namespace

void describe(const core::Model& model, const core::Stepper& stepper, core::Reductions& ranks, int threads,
              io::Log& log) {
  const core::GridGeometry& g = model.grid->geometry();
  std::int64_t counts[2] = {static_cast<std::int64_t>(model.local_particles()), model.grid->owned()};
  const auto particles = ranks.spread(static_cast<double>(counts[0]));
  const core::MemoryNeed need = core::memory_need(model);
  const auto memory = ranks.spread(need.total());
  ranks.sum(std::span<std::int64_t>(counts));
  log.say("grid       {} x {} x {} cells of {:.6g} x {:.6g} x {:.6g}; {} bricks of 4 x 4 x 4 cells in use",
          g.cells[0], g.cells[1], g.cells[2], g.cell.x, g.cell.y, g.cell.z, counts[1]);
  log.say("particles  {}, on {} rank(s) x {} thread(s): {:.0f} to {:.0f} per rank", counts[0], ranks.size(),
          threads, particles.min, particles.max);
  log.say("memory     {} for particles, bricks and bodies, maximum over the ranks",
          bytes_in_words(memory.max));
  describe_materials(model, log);
  describe_bodies(model, log);
  describe_loads(model, ranks, log);
  std::string phases;
  for (const core::Phase& p : stepper.phases()) phases += (phases.empty() ? "" : " | ") + p.name;
  log.say("step       {}", phases);
  if (model.clock.scheme_since > 0) log.say("scheme     USAVG since step {}", model.clock.scheme_since);
  if (core::may_change_scheme(*model.scene) && model.scheme == core::Scheme::musl)
    log.say(
        "scheme     MUSL, and USAVG from the step on at which the energy balance is off by more than {:.2g} "
        "%",
        100 * core::tolerated_drift);
  const double critical = model.clock.critical_dt;
  log.say("time step  critical {}, end time {:.6g}",
          std::isfinite(critical) ? fmt::format("{:.6g}", critical) : "without limit",
          model.scene->solution.end_time);
}

void warn_of_long_step(const core::Model& model, io::Log& log) {
  const core::SolutionInput& solution = model.scene->solution;
  const double specified = solution.time_step.specified, critical = model.clock.critical_dt;
  constexpr double rounded = 1 + 1e-4;  // the critical step as this log prints it is accepted
  if (solution.integration == core::Integration::implicit || !(specified > rounded * critical)) return;
  log.warn(
      "the specified time step {:.6g} is {:.3g} times the critical step {:.6g}: the run may be unstable; "
      "specify less, or remove specified",
      specified, specified / critical, critical);
}

void say_thermal_pressures(const core::Model& model, core::Reductions& ranks, io::Log& log) {
  const std::vector<const core::BodyInput*> inputs = core::active_bodies(*model.scene);
  if (std::ranges::none_of(inputs, [](const auto* input) { return input->initial_temperature.has_value(); }))
    return;
  std::vector<double> lowest(2 * model.bodies.size(), 0.0);  // minima of the pressure and of its negative
  for (const core::ConstParticleBlock& block : core::blocks_of(model)) {
    const auto b = static_cast<std::size_t>(block.body);
    if (!inputs[b]->initial_temperature) continue;
    for (const core::ConstParticle p : block) {
      lowest[2 * b] = std::min(lowest[2 * b], p[core::Column::pressure]);
      lowest[2 * b + 1] = std::min(lowest[2 * b + 1], -p[core::Column::pressure]);
    }
  }
  ranks.minimum(lowest);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const double p = -lowest[2 * b + 1] > -lowest[2 * b] ? -lowest[2 * b + 1] : lowest[2 * b];
    const core::ConstitutiveModel& material = *model.bodies[b].model;
    const double c = material.initial_sound_speed(), s = material.initial_shear_speed();
    const double bulk = material.reference_density() * (c * c - 4.0 / 3 * s * s);
    if (!inputs[b]->initial_temperature || !(std::abs(p) > 1e-6 * bulk)) continue;
    const double change = p / bulk;
    log.note("note       body '{}' starts with the pressure {:.6g}, including thermal pressure{}",
             model.bodies[b].name, p,
             std::abs(change) > 0.1
                 ? ""
                 : fmt::format("; with density=\"{:.6g}\" it would start nearly free of pressure",
                               inputs[b]->density * (1 - change)));
  }
}

void say_large_strains(const core::Model& model, core::Reductions& ranks, io::Log& log) {
  if (model.scene->solution.volume.update != core::VolumeUpdate::accumulated_strain) return;
  constexpr double notable = 0.01;  // of the volume; a strain of 0.14 along one axis
  std::int64_t count = 0;
  double largest = 0;
  for (const core::ConstParticleBlock& block : core::blocks_of(model)) {
    if (!block.layout->has(core::Column::strain_xx)) continue;
    for (const core::ConstParticle p : block) {
      const double xx = p[core::Column::strain_xx], yy = p[core::Column::strain_yy],
                   zz = p[core::Column::strain_zz];
      // The strains are logarithmic: their trace is exact.
      const double error = std::abs((1 + xx) * (1 + yy) * (1 + zz) * std::exp(-(xx + yy + zz)) - 1);
      if (error > notable) ++count;
      largest = std::max(largest, error);
    }
  }
  ranks.sum(std::span<std::int64_t>(&count, 1));
  largest = ranks.largest(largest);
  if (count > 0)
    log.warn(
        "Volume update_type 4 is for small strains: at the end the volumes of {} particle(s) are wrong by "
        "more "
        "than {:.3g} %, of one by {:.3g} %; use update_type 0 or 3",
        count, 100 * notable, 100 * largest);
}

void say_what_was_counted(const core::Model& model, core::Reductions& ranks, io::Log& log) {
  const core::MaterialEvents& events = model.ledger.events;
  std::int64_t counts[] = {events.failed,
                           events.negative_volume,
                           events.volume_limited,
                           events.undefined_root,
                           events.unresolved,
                           model.ledger.velocity_limited,
                           model.ledger.wide_domains,
                           model.ledger.tangled_domains};
  const bool boxes = model.scene->grid.shape == core::ShapeFunction::contiguous_particle_gimp;
  const char* const words[] = {
      "failed",
      "with an update to zero or negative volume; the old volume was kept",
      "limited by Volume min or max",
      "with undefined wave speed: its square was negative, or the compression exceeded the limit of the "
      "equation of state",
      "with a strain increment too large for the return to the yield surface: use a smaller TimeStep "
      "factor",
      "limited by LimitVelocity",
      boxes
          ? "with a domain wider than a cell, limited to one cell: use CPDI or larger cells"
          : "with a domain that extends more than a cell from the particle, limited to one cell, in a fluid "
            "replaced by a cube: use larger cells",
      "with a tangled domain, replaced by a parallelepiped or a cube: use smaller steps or CPDI"};
  ranks.sum(std::span<std::int64_t>(counts));
  for (std::size_t i = 0; i < std::size(counts); ++i) {
    if (counts[i] > 0) log.say("counted    {} particle(s) {}", counts[i], words[i]);
  }
}

}  // namespace mpm::apps
