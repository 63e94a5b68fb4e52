# mpm_library(core [EXCLUDE regex] LINK dep...): library mpm_core, alias mpm::core, from every source below the current
# folder that does not match EXCLUDE, and SOURCES; without any, a library of headers. Not installed by itself: libmpm
# (apps/CMakeLists.txt) holds them all.
function(mpm_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "EXCLUDE" "SOURCES;LINK")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp)
  if(arg_EXCLUDE)
    list(FILTER sources EXCLUDE REGEX ${arg_EXCLUDE})
  endif()
  list(APPEND sources ${arg_SOURCES})
  set(target mpm_${name})
  if(sources)
    set(scope PUBLIC)
    add_library(${target} STATIC ${sources})
    mpm_compile(${target})
    mpm_precompile(${target} mpm_core)
  else()
    set(scope INTERFACE)
    add_library(${target} INTERFACE)
  endif()
  add_library(mpm::${name} ALIAS ${target})
  target_include_directories(${target} ${scope}
    ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/generated)
  target_link_libraries(${target} ${scope} ${arg_LINK})
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()

# mpm_programs(out_targets LINK dep...): one program per source directly in the current folder.
function(mpm_programs out)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LINK")
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  set(targets "")
  foreach(source IN LISTS sources)
    cmake_path(GET source STEM name)
    add_executable(${name} ${source})
    target_link_libraries(${name} PRIVATE ${arg_LINK})
    mpm_compile(${name})
    list(APPEND targets ${name})
  endforeach()
  set(${out} ${targets} PARENT_SCOPE)
endfunction()

# mpm_helpers(target [SOURCES file...] LINK dep...): a static library that is not installed; without sources, an
# empty one.
function(mpm_helpers target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LINK")
  if(arg_SOURCES)
    add_library(${target} STATIC ${arg_SOURCES})
    target_link_libraries(${target} PUBLIC ${arg_LINK})
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    mpm_compile(${target})
    mpm_precompile(${target} mpm_core)
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE ${arg_LINK})
  endif()
endfunction()

# Warnings, for our own sources only.
function(mpm_compile target)
  target_compile_options(${target} PRIVATE ${mpm_private_options})
  if(MPM_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL Clang AND NOT target MATCHES "^(mpm|test)_(core|physics|test_support)$")
    # Instrumented code takes clang twice as long with -O1; what does the arithmetic of the steps needs it.
    target_compile_options(${target} PRIVATE -O0)
  endif()
  get_target_property(type ${target} TYPE)
  if(MPM_SANITIZE AND type STREQUAL EXECUTABLE)
    target_sources(${target} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/keep_plugins.cpp)
  endif()
endfunction()

# mpm_optimise_little(source...): for sources that run once or only check: favours compile time over speed.
function(mpm_optimise_little)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS "$<$<CONFIG:Release>:-O1>")
  endif()
endfunction()

# mpm_precompile(target owner header...): the headers that many sources include, and those given, are compiled once, for
# `owner`, and so for each target of the same kind that names it.
function(mpm_precompile target owner)
  if(NOT MPM_PRECOMPILE)
    return()
  endif()
  if(target STREQUAL owner)
    target_precompile_headers(${target} PRIVATE
      <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <map> <memory> <numbers> <optional>
      <span> <stdexcept> <string> <string_view> <utility> <variant> <vector> <fmt/format.h> ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()

# mpm_embed(out_source XML_FILE): a source that holds the file as mpm::io::embedded::<stem>, a std::string_view
# declared by "io/embedded/<stem>.hpp"; stem in lower case.
function(mpm_embed out file)
  cmake_path(GET file STEM LAST_ONLY stem)
  string(TOLOWER ${stem} stem)
  set(base ${PROJECT_BINARY_DIR}/generated/io/embedded/${stem})
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed.cmake)
  add_custom_command(OUTPUT ${base}.cpp ${base}.hpp
    COMMAND ${CMAKE_COMMAND} -DFILE=${file} -DNAME=${stem} -DBASE=${base} -P ${script}
    DEPENDS ${file} ${script} COMMENT "Embedding ${stem}" VERBATIM)
  set(${out} ${base}.cpp ${base}.hpp PARENT_SCOPE)
endfunction()
