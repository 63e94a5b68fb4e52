# Run as a script at every build: writes OUTPUT, the definitions behind core/version.hpp, if the state of the git
# checkout SOURCE_DIR has changed.
set(git git --no-optional-locks -c safe.directory=* -C ${SOURCE_DIR})
execute_process(COMMAND ${git} rev-parse --verify --short=12 HEAD
  OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  set(hash unknown)
endif()
execute_process(COMMAND ${git} status --porcelain OUTPUT_VARIABLE changes ERROR_QUIET)
set(dirty false)
if(changes)
  set(dirty true)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "core/version.hpp"

namespace mpm::core {
constinit const std::string_view git_hash = "@hash@";
constinit const bool git_dirty = @dirty@;
}  // namespace mpm::core
]])
