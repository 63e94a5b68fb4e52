// The samples are complete: whoever adds a law adds its parameters.

#include "tests/physics/samples.hpp"

#include <catch2/catch.hpp>

#include "physics/catalogue.hpp"

namespace mpm::tests {

namespace {

using core::MaterialInput;

template <class Types, class Used>
void require_samples_of(const Types& types, Used used) {
  for (const core::TypeInfo& type : types) {
    if (type.name == "none") continue;
    INFO("no sample for the law " << type.name << ": add one to tests/physics/samples.cpp");
    bool found = false;
    for (const Sample& s : samples()) found = found || used(s.input, type.name);
    REQUIRE(found);
  }
}

}  // namespace

TEST_CASE("every law of the lists has a sample", "[physics]") {
  const core::Catalogue catalogue = physics::catalogue();
  require_samples_of(catalogue.strength,
                     [](const MaterialInput& i, std::string_view name) { return i.strength.type == name; });
  require_samples_of(catalogue.eos, [](const MaterialInput& i, std::string_view name) {
    return i.eos && i.eos->type == name;
  });
  require_samples_of(catalogue.failure, [](const MaterialInput& i, std::string_view name) {
    return !i.failures.empty() && i.failures.front().type == name;
  });
}

}  // namespace mpm::tests
