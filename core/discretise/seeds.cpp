#include "core/discretise/seeds.hpp"

#include "core/discretise/make_source.hpp"
#include "core/discretise/shape_check.hpp"

namespace mpm::core {

std::unique_ptr<SeedSource> make_seed_source(const Scene& scene, const BodyInput& body) {
  if (std::vector<Diagnostic> errors = shape_errors(scene, body); !errors.empty())
    throw InputErrors(std::move(errors));
  std::unique_ptr<SeedSource> source = make_unchecked_source(scene, body);
  if (made_of_files(scene, body) && is_surely_empty(*source)) throw InputErrors({no_particles(scene, body)});
  return source;
}

}  // namespace mpm::core
