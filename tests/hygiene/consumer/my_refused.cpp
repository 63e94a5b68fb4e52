// Laws that the registry must refuse: a name that is taken, and a parameter without range and meaning.
#include "laws.hpp"

#include "apps/mpm.hpp"

struct Taken : mine::Hardening {
  static constexpr std::string_view name = "IsoHarden";
};
struct Bare : mine::Bulk {
  static constexpr std::string_view name = "Bare";
  static constexpr auto parameters() {
    return std::array<mpm::physics::Parameter<Bare>, 1>{{{&Bare::a1, {.name = "A1", .required = true}}}};
  }
};

int main(int argc, char** argv) { return mpm::run(argc, argv, mpm::Registry().add<Taken>().add<Bare>()); }
