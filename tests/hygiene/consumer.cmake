# Installs the build into a folder of its own, then configures, builds and runs a project that only knows this folder.
set(work ${MPM_BUILD}/tests/consumer)
file(REMOVE_RECURSE ${work})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

set(flags "")
if(SANITIZE)
  set(flags -fsanitize=address,undefined)
endif()
run(${CMAKE_COMMAND} --install ${MPM_BUILD} --prefix ${work}/prefix)
run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${work}/build
  -DCMAKE_PREFIX_PATH=${work}/prefix -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DCMAKE_CXX_FLAGS=${flags}
  -DCMAKE_C_COMPILER=${C_COMPILER} -DCMAKE_CXX_COMPILER=${CXX_COMPILER})
run(${CMAKE_COMMAND} --build ${work}/build)
run(${CMAKE_COMMAND} -E env ASAN_OPTIONS=detect_leaks=0 ${work}/build/consumer)  # what MPI leaves is not its matter
if(NOT output MATCHES "^mpm ${VERSION} ")
  message(FATAL_ERROR "expected version ${VERSION}, the program printed: ${output}")
endif()
message(STATUS "${output}")
