// mpm_hjc --fc STRESS [--tension STRESS] ...: derived parameters of Holmquist-Johnson-Cook concrete
// (manual 5.2), with P* = 1/3 the pressure of unconfined compression over fc:
//   T* = T/fc (5.1),   D1 = ep/(P* + T*) (5.2),   PCrush = fc/3 (5.3),   MuCrush = PCrush/Kel (5.4)
// and Kel, G from Young's modulus and Poisson's ratio (6.1). Exit code 0 done, 2 wrong input.

#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

const CLI::Validator positive_number(
    [](const std::string& text) -> std::string {
      double value = 0;
      const bool number = CLI::detail::lexical_cast(text, value);
      return number && value > 0 && std::isfinite(value) ? "" : text + " is not a number greater than 0";
    },
    "> 0");

struct Settings {
  double fc = 0;
  std::optional<double> tension, fracture_strain, bulk, shear, young, poisson;
  bool attributes = false;
};

struct Elasticity {
  double young, poisson, bulk, shear;
};

/// All four constants from any two; nullopt if none is given.
std::optional<Elasticity> elasticity(const Settings& s) {
  const int given = (s.young ? 1 : 0) + (s.poisson ? 1 : 0) + (s.bulk ? 1 : 0) + (s.shear ? 1 : 0);
  if (given == 0) return {};
  if (given != 2 && !(given == 1 && s.bulk)) {
    throw CLI::ValidationError("elastic constants",
                               "two of --young, --poisson, --bulk and --shear are needed, or --bulk alone");
  }
  if (given == 1) return Elasticity{NAN, NAN, *s.bulk, NAN};
  double nu = 0;
  if (s.poisson) {
    nu = *s.poisson;
  } else if (s.young) {
    nu = s.bulk ? 0.5 - *s.young / (6 * *s.bulk) : *s.young / (2 * *s.shear) - 1;
  } else {
    nu = (3 * *s.bulk - 2 * *s.shear) / (2 * (3 * *s.bulk + *s.shear));
  }
  if (!(nu > -1 && nu < 0.5)) {
    throw CLI::ValidationError("elastic constants",
                               fmt::format("they give a Poisson's ratio of {}, not within -1 and 0.5", nu));
  }
  const double young = s.young ? *s.young : s.shear ? 2 * *s.shear * (1 + nu) : 3 * *s.bulk * (1 - 2 * nu);
  return Elasticity{young, nu, young / (3 * (1 - 2 * nu)), young / (2 * (1 + nu))};
}

void print(const char* name, double value, const char* meaning) {
  fmt::print("{:<10} {:<14.8g} {}\n", name, value, meaning);
}

void convert(const Settings& s) {
  if (s.fracture_strain && !s.tension) {
    throw CLI::ValidationError("--fracture-strain", "D1 needs --tension as well");
  }
  const std::optional<Elasticity> elastic = elasticity(s);
  const double p_crush = s.fc / 3;
  const double t_star = s.tension ? *s.tension / s.fc : 0;
  const double d1 = s.fracture_strain ? *s.fracture_strain / (1.0 / 3 + t_star) : 0;
  if (s.attributes) {
    std::string strength = fmt::format("fc=\"{:.8g}\"", s.fc),
                eos = fmt::format("PCrush=\"{:.8g}\"", p_crush);
    if (s.tension) strength += fmt::format(" T=\"{:.8g}\"", *s.tension);
    if (s.fracture_strain) strength += fmt::format(" D1=\"{:.8g}\"", d1);
    if (elastic) eos += fmt::format(" MuCrush=\"{:.8g}\"", p_crush / elastic->bulk);
    if (elastic && !std::isnan(elastic->young)) {
      strength += fmt::format(" Young=\"{:.8g}\" Poisson=\"{:.8g}\"", elastic->young, elastic->poisson);
      eos += fmt::format(" Poisson=\"{:.8g}\"", elastic->poisson);
    }
    fmt::print("StrengthModel   {}\nEquationOfState {}\n", strength, eos);
    return;
  }
  if (s.tension) print("T*", t_star, "T/fc");
  if (s.fracture_strain) print("D1", d1, "strain to fracture/(1/3 + T*), for D2 = 1");
  print("PCrush", p_crush, "fc/3");
  if (!elastic) return;
  print("MuCrush", p_crush / elastic->bulk, "PCrush/Kel");
  print("Kel", elastic->bulk, "bulk modulus");
  if (std::isnan(elastic->young)) return;
  print("G", elastic->shear, "shear modulus");
  print("Young", elastic->young, "Young's modulus");
  print("Poisson", elastic->poisson, "Poisson's ratio");
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app(
      "Derived parameters of Holmquist-Johnson-Cook concrete. All stresses in the same unit; parameters that "
      "need a value not given are omitted.");
  const auto positive = [&](const char* name, std::optional<double>& value, const char* meaning) {
    app.add_option(name, value, meaning)->check(positive_number);
  };
  app.add_option("--fc", settings.fc, "unconfined compressive strength")->required()->check(positive_number);
  positive("--tension", settings.tension, "tensile strength T: gives T*");
  positive("--fracture-strain", settings.fracture_strain,
           "plastic strain to fracture in unconfined compression: gives D1, with --tension");
  positive("--bulk", settings.bulk, "elastic bulk modulus: gives MuCrush, as do any two elastic constants");
  positive("--shear", settings.shear, "shear modulus");
  positive("--young", settings.young, "Young's modulus");
  app.add_option("--poisson", settings.poisson, "Poisson's ratio")->check(CLI::Range(-1.0, 0.5));
  app.add_flag("--attributes", settings.attributes, "print as attributes of an input file");
  try {
    app.parse(argc, argv);
    convert(settings);
    return 0;
  } catch (const CLI::ParseError& error) { return app.exit(error) == 0 ? 0 : 2; }
}
