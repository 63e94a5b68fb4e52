#include "apps/common/point_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <stdexcept>

#include <fmt/format.h>

#include "io/input/text.hpp"

namespace mpm::apps {

using core::Sym3;

struct PointTable::Column {
  std::string_view name;
  std::string_view dimension;
  std::function<double(const physics::PathPoint&)> value;
};

PointTable::PointTable(const physics::PointDriver& point, const std::optional<core::UnitSystem>& units)
    : point_(point), units_(units) {}

std::vector<PointTable::Column> PointTable::columns() const {
  using At = const physics::PathPoint&;
  const physics::PointDriver& p = point_;
  std::vector<Column> all{
      {"time", "time", [&p](At) { return p.time(); }},
      {"leg", "1", [](At at) { return at.leg + 1.0; }},
      {"strain", "1", [](At at) { return at.strain; }},
  };
  struct Component {
    std::string_view strain, stress;
    double Sym3<double>::*member;
  };
  constexpr std::array<Component, 6> components{{{"strain_xx", "stress_xx", &Sym3<double>::xx},
                                                 {"strain_yy", "stress_yy", &Sym3<double>::yy},
                                                 {"strain_zz", "stress_zz", &Sym3<double>::zz},
                                                 {"strain_xy", "stress_xy", &Sym3<double>::xy},
                                                 {"strain_yz", "stress_yz", &Sym3<double>::yz},
                                                 {"strain_xz", "stress_xz", &Sym3<double>::xz}}};
  for (const Component& c : components)
    all.push_back({c.strain, "1", [c](At at) { return at.total_strain.*c.member; }});
  for (const Component& c : components)
    all.push_back({c.stress, "stress", [&p, c](At) { return p.stress().*c.member; }});
  all.push_back({"pressure", "stress", [&p](At) { return p.value(core::Column::pressure); }});
  all.push_back({"viscous_pressure", "stress", [&p](At) { return p.value(core::Column::viscous_pressure); }});
  all.push_back({"von_mises", "stress", [&p](At) { return mises(p.deviator()); }});
  all.push_back({"volume_ratio", "1", [&p](At) { return p.volume_ratio(); }});
  all.push_back({"density", "density", [&p](At) { return p.density(); }});
  all.push_back({"internal_energy", "stress", [&p](At) { return p.energy(); }});
  all.push_back({"sound_speed", "velocity", [&p](At) { return p.sound_speed(); }});
  // Further columns of the laws, in the order of the columns.
  using enum core::Column;
  for (const core::Column column : {effective_plastic_strain,
                                    yield_stress,
                                    damage,
                                    temperature,
                                    failed,
                                    threshold_factor,
                                    thermal_strain,
                                    porosity,
                                    max_compression,
                                    bulking_pressure,
                                    burn_fraction,
                                    plastic_volumetric_strain,
                                    history_0,
                                    history_1,
                                    history_2,
                                    history_3,
                                    history_4,
                                    history_5,
                                    history_6,
                                    history_7})
    if (p.has(column)) {
      const core::ColumnInfo& info = core::column_table[static_cast<std::size_t>(column)];
      all.push_back({info.name, info.dimension, [&p, column](At) { return p.value(column); }});
    }
  return all;
}

std::string PointTable::unit(std::string_view dimension) const {
  return units_ ? units_->unit_name(core::parse_dimension(dimension)) : std::string(dimension);
}

std::string PointTable::heading() const {
  std::string names, units;
  for (const Column& column : columns()) {
    names.append(names.empty() ? "" : ",").append(column.name);
    units.append(units.empty() ? "" : ",").append(unit(column.dimension));
  }
  return fmt::format("{}\n{}\n", names, units);
}

std::string PointTable::row(const physics::PathPoint& at) const {
  std::string text;
  for (const Column& column : columns())
    fmt::format_to(std::back_inserter(text), "{}{}", text.empty() ? "" : ",", column.value(at));
  text.push_back('\n');
  return text;
}

PointSample sample(const physics::PointDriver& point, const physics::PathPoint& at) {
  const Sym3<double> stress = point.stress();
  return {at.total_strain, stress, -trace(stress) / 3, mises(point.deviator()), point.volume_ratio()};
}

std::vector<Measurement> read_measurements(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(fmt::format("{}: cannot be read", file));
  std::vector<Measurement> all;
  std::size_t strain = 0, stress = 1;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::vector<std::string_view> words;
    for (std::size_t at = 0; at < line.size();) {
      const std::size_t begin = line.find_first_not_of(" \t\r,;", at);
      if (begin == line.npos) break;
      at = std::min(line.find_first_of(" \t\r,;", begin), line.size());
      words.push_back(std::string_view(line).substr(begin, at - begin));
    }
    if (words.empty()) continue;
    if (!io::parse_real(words[0])) {
      const auto column = [&](std::string_view name, std::size_t otherwise) {
        const auto found = std::ranges::find(words, name);
        return found == words.end() ? otherwise : static_cast<std::size_t>(found - words.begin());
      };
      strain = column("strain", strain);
      stress = column("stress", column("stress_xx", stress));
      continue;
    }
    const auto value = [&](std::size_t i) {
      return i < words.size() ? io::parse_real(words[i]) : std::optional<double>();
    };
    if (!value(strain) || !value(stress))
      throw std::runtime_error(fmt::format("{}, line {}: expected strain and stress", file, number));
    all.push_back({*value(strain), *value(stress)});
  }
  if (all.empty()) throw std::runtime_error(fmt::format("{}: no line of strain and stress", file));
  return all;
}

Curve stress_strain(const std::vector<PointSample>& samples) {
  double axial = 0, shear = 0;
  for (const PointSample& s : samples) {
    axial = std::max(axial, std::abs(s.strain.xx));
    shear = std::max(shear, std::abs(2 * s.strain.xy));
  }
  Curve curve;
  curve.shear = shear > axial;
  for (const PointSample& s : samples)
    curve.points.push_back(curve.shear ? Measurement{2 * s.strain.xy, s.stress.xy}
                                       : Measurement{s.strain.xx, s.stress.xx});
  return curve;
}

Misfit misfit(const Curve& curve, const std::vector<Measurement>& measured) {
  Misfit result;
  double sum = 0;
  for (const Measurement& m : measured) {
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
      const Measurement &a = curve.points[i - 1], &b = curve.points[i];
      if ((a.strain - m.strain) * (b.strain - m.strain) > 0 || a.strain == b.strain) continue;
      const double stress = a.stress + (b.stress - a.stress) * (m.strain - a.strain) / (b.strain - a.strain);
      sum += (stress - m.stress) * (stress - m.stress);
      result.largest = std::max(result.largest, std::abs(m.stress));
      ++result.points;
      break;
    }
  }
  if (result.points > 0) result.rms = std::sqrt(sum / result.points);
  return result;
}

}  // namespace mpm::apps
