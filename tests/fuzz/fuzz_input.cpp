// Whatever the bytes, the input reader returns a scene or throws core::InputErrors; and the echo of a scene
// is an input again that has the same echo.  Run: fuzz_input -max_len=16384 NEW_INPUTS tests/fuzz/corpus

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/scene/errors.hpp"
#include "io/input/echo.hpp"
#include "io/input/reader.hpp"
#include "io/input/specification.hpp"
#include "physics/catalogue.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace mpm;
  static const io::ElementSpec language = io::language(physics::catalogue());
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  io::ReadOptions options{.check_files = false, .accept_later = true};
  std::string echo;
  try {
    echo = io::to_text(io::parse_scene(bytes, "fuzz.xmp", language, options));
  } catch (const core::InputErrors& errors) {
    if (errors.diagnostics().empty()) std::abort();
    return 0;
  }
  // Not caught: a scene that was read must be read again.
  if (io::to_text(io::parse_scene(echo, "echo.xmp", language, options)) != echo) std::abort();
  return 0;
}
