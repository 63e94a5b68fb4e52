# User options and the resulting compiler flags.

set(MPM_ARCH native CACHE STRING "Value of -march; empty: the compiler's baseline")
set(MPM_SIMD_LANES auto CACHE STRING "Doubles per SIMD vector: 1, 2, 4, 8, or auto for the widest that MPM_ARCH has")
set_property(CACHE MPM_SIMD_LANES PROPERTY STRINGS auto 1 2 4 8)
option(MPM_ASSERTIONS "Check invariants at run time" OFF)
option(MPM_SANITIZE "Build with the address and undefined-behaviour sanitizers" OFF)
option(MPM_BRIEF_TESTS "Unit tests: few steps, and none that judge accuracy alone" OFF)
option(MPM_RACE "Build with the thread sanitizer, for the target race (clang with libomp)" OFF)
option(MPM_WERROR "Treat warnings as errors" OFF)
option(MPM_PRECOMPILE "Read the standard library's headers once for all sources (g++)" ON)
option(MPM_FUZZ "Build the libFuzzer harnesses under tests/fuzz (clang)" OFF)
option(MPM_WITH_PETSC "Build the solver of implicit steps, over PETSc" ON)
option(MPM_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL})
option(MPM_BENCHMARKS "Build the benchmarks" ${PROJECT_IS_TOP_LEVEL})

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

find_program(CCACHE_PROGRAM ccache)
mark_as_advanced(CCACHE_PROGRAM)
if(CCACHE_PROGRAM AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  # With paths relative to the source folder one checkout finds what another one has compiled. Without the sloppiness
  # ccache does not cache sources that use precompiled headers.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1)
  if(MPM_PRECOMPILE)
    list(APPEND CMAKE_CXX_COMPILER_LAUNCHER CCACHE_SLOPPINESS=pch_defines,time_macros)
  endif()
  list(APPEND CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

set(mpm_arch_flags "")
if(MPM_ARCH)
  set(mpm_arch_flags -march=${MPM_ARCH})
endif()

execute_process(
  COMMAND ${CMAKE_CXX_COMPILER} ${mpm_arch_flags} -dM -E -x c++ /dev/null
  OUTPUT_VARIABLE arch_macros ERROR_VARIABLE arch_error RESULT_VARIABLE arch_result)
if(NOT arch_result EQUAL 0)
  message(FATAL_ERROR "The compiler rejects MPM_ARCH=${MPM_ARCH}:\n${arch_error}")
endif()
if(MPM_SIMD_LANES STREQUAL "auto")
  if(arch_macros MATCHES "__AVX512F__")
    set(mpm_simd_lanes 8)
  elseif(arch_macros MATCHES "__AVX__")
    set(mpm_simd_lanes 4)
  else()
    set(mpm_simd_lanes 2)
  endif()
elseif(MPM_SIMD_LANES MATCHES "^[1248]$")
  set(mpm_simd_lanes ${MPM_SIMD_LANES})
else()
  message(FATAL_ERROR "MPM_SIMD_LANES=${MPM_SIMD_LANES}: expected 1, 2, 4, 8 or auto")
endif()

# Everything that changes the value of a result is PUBLIC on mpm_core. Contraction is spelled out because compilers
# differ in its default; reassociation (-ffast-math) would break bitwise reproducibility. Projects that use the
# installed library get all of it but -march, which is theirs to choose: no vector crosses the library's boundary
# (apps/CMakeLists.txt), so g++'s notes on how vectors are passed do not concern them.
set(mpm_value_options -ffp-contract=fast -fno-math-errno -fno-trapping-math)
set(mpm_public_options ${mpm_arch_flags} ${mpm_value_options})
set(mpm_consumer_options ${mpm_value_options} -Wno-psabi)
set(mpm_public_definitions MPM_SIMD_LANES=${mpm_simd_lanes})
set(mpm_private_options -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wno-psabi)
if(MPM_WERROR)
  list(APPEND mpm_private_options -Werror)
endif()
if(MPM_ASSERTIONS)
  list(APPEND mpm_public_definitions MPM_ASSERTIONS=1 _GLIBCXX_ASSERTIONS)
  list(APPEND mpm_private_options -UNDEBUG)
endif()
if(MPM_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # g++ spends four fifths of the compile time of the inlined kernels on this check.
    add_compile_options(-fno-sanitize-address-use-after-scope)
    # Instrumented code hides initialisations from g++.
    list(APPEND mpm_private_options -Wno-maybe-uninitialized)
  endif()
endif()
if(MPM_RACE)
  add_compile_options(-fsanitize=thread)
  add_link_options(-fsanitize=thread)
endif()
if(MPM_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

if(MPM_PRECOMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # g++ 12 treats precompiled system headers as ours; the preset dev reports our warnings.
  list(APPEND mpm_private_options
    -Wno-array-bounds -Wno-maybe-uninitialized -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)
else()
  set(MPM_PRECOMPILE OFF)  # clang requires identical options and definitions
endif()

message(STATUS "mpm: ${CMAKE_BUILD_TYPE}, arch '${MPM_ARCH}', ${mpm_simd_lanes} SIMD lanes, "
  "assertions ${MPM_ASSERTIONS}, sanitizers ${MPM_SANITIZE}")
