// The plot of mpm_point: plain SVG, written without a library.

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "apps/common/point_table.hpp"
#include "io/output/provenance.hpp"

namespace mpm::apps {

namespace {

using Points = std::vector<std::pair<double, double>>;

/// An axis between round numbers with ticks of 1, 2 or 5 times a power of ten.
struct Axis {
  double low = 0, high = 1, tick = 0.2;

  void cover(double least, double most) {
    const double size = std::max({std::abs(least), std::abs(most), 1e-300});
    if (most - least < 1e-9 * size) {  // constant up to round-off
      least -= 0.5 * size;
      most += 0.5 * size;
    }
    const double raw = (most - least) / 5, ten = std::pow(10, std::floor(std::log10(raw)));
    tick = ten * (raw <= 1.0001 * ten ? 1 : raw <= 2 * ten ? 2 : raw <= 5 * ten ? 5 : 10);
    low = tick * std::floor(least / tick + 1e-9);
    high = tick * std::ceil(most / tick - 1e-9);
  }
};

class Panel {
 public:
  Panel(double left, std::string x_title, std::string y_title)
      : left_(left), x_title_(std::move(x_title)), y_title_(std::move(y_title)) {}

  std::string draw(const Points& line, const Points& marks) {
    cover(line, marks);
    std::string svg = frame();
    svg += "<polyline class=\"curve\" points=\"";
    // More points than pixels enlarge the file without improving the plot.
    const std::size_t stride = std::max<std::size_t>(1, line.size() / 4000);
    for (std::size_t i = 0; i < line.size(); ++i)
      if (i % stride == 0 || i + 1 == line.size())
        svg += fmt::format("{:.1f},{:.1f} ", x_of(line[i].first), y_of(line[i].second));
    svg += "\"/>\n";
    for (const auto& [x, y] : marks)
      svg += fmt::format("<circle class=\"mark\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\"/>\n", x_of(x), y_of(y));
    return svg;
  }

 private:
  static constexpr double width = 300, height = 260, top = 50;

  double x_of(double x) const { return left_ + width * (x - x_.low) / (x_.high - x_.low); }
  double y_of(double y) const { return top + height * (1 - (y - y_.low) / (y_.high - y_.low)); }

  void cover(const Points& line, const Points& marks) {
    double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
    for (const Points* points : {&line, &marks}) {
      for (const auto& [x, y] : *points) {
        if (!std::isfinite(x) || !std::isfinite(y)) continue;
        x0 = std::min(x0, x);
        x1 = std::max(x1, x);
        y0 = std::min(y0, y);
        y1 = std::max(y1, y);
      }
    }
    if (x0 > x1) return;
    x_.cover(x0, x1);
    y_.cover(y0, y1);
  }

  std::string frame() const {
    std::string svg;
    const auto ticks = [](const Axis& axis, const auto& draw) {
      const int count = static_cast<int>(std::lround((axis.high - axis.low) / axis.tick));
      for (int i = 0; i <= count; ++i) {
        const double value = axis.low + i * axis.tick;
        draw(value, fmt::format("{:.4g}", std::abs(value) < 1e-9 * axis.tick ? 0.0 : value));
      }
    };
    ticks(x_, [&](double v, const std::string& label) {
      svg += fmt::format(
          "<path class=\"grid\" d=\"M{0:.1f},{1}V{2}\"/><text x=\"{0:.1f}\" y=\"{3}\">{4}</text>\n", x_of(v),
          top, top + height, top + height + 16, label);
    });
    ticks(y_, [&](double v, const std::string& label) {
      svg += fmt::format(
          "<path class=\"grid\" d=\"M{0},{1:.1f}H{2}\"/><text class=\"y\" x=\"{3}\" "
          "y=\"{4:.1f}\">{5}</text>\n",
          left_, y_of(v), left_ + width, left_ - 6, y_of(v) + 4, label);
    });
    svg += fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", left_, top,
                       width, height);
    svg += fmt::format("<text class=\"title\" x=\"{}\" y=\"{}\">{}</text>\n", left_ + width / 2,
                       top + height + 38, io::xml_escaped(x_title_));
    svg += fmt::format("<text class=\"title\" transform=\"translate({},{}) rotate(-90)\">{}</text>\n",
                       left_ - 62, top + height / 2, io::xml_escaped(y_title_));
    return svg;
  }

  double left_;
  std::string x_title_, y_title_;
  Axis x_, y_;
};

}  // namespace

std::string plot(std::string_view title, const std::vector<PointSample>& samples,
                 const std::vector<Measurement>& measured, const std::string& stress_unit) {
  const Curve curve = stress_strain(samples);
  Points stress, invariants, volume, marks;
  for (const Measurement& m : curve.points) stress.emplace_back(m.strain, m.stress);
  for (const Measurement& m : measured) marks.emplace_back(m.strain, m.stress);
  for (const PointSample& s : samples) {
    invariants.emplace_back(s.pressure, s.mises);
    volume.emplace_back(s.volume_ratio, s.pressure);
  }
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1200\" height=\"370\" viewBox=\"0 0 1200 370\">\n"
      "<style>text{font:12px sans-serif;text-anchor:middle}.y{text-anchor:end}.title{font-size:13px}"
      ".grid{stroke:#ddd}.frame{fill:none;stroke:#444}.curve{fill:none;stroke:#0b5fa5;stroke-width:1.8}"
      ".mark{fill:none;stroke:#c0392b;stroke-width:1.4}</style>\n"
      "<rect width=\"1200\" height=\"370\" fill=\"white\"/>\n";
  svg += fmt::format("<text class=\"title\" x=\"600\" y=\"24\">{}</text>\n", io::xml_escaped(title));
  const std::string unit = fmt::format(" ({})", stress_unit);
  svg += Panel(90, curve.shear ? "shear strain gamma_xy" : "strain_xx",
               (curve.shear ? "stress_xy" : "stress_xx") + unit)
             .draw(stress, marks);
  svg += Panel(480, "pressure p" + unit, "von Mises stress q" + unit).draw(invariants, {});
  svg += Panel(870, "volume V/V0", "pressure p" + unit).draw(volume, {});
  return svg + "</svg>\n";
}

}  // namespace mpm::apps
