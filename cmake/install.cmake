include(CMakePackageConfigHelpers)

# The headers that a law needs. They include nothing but the standard library and each other.
foreach(folder IN ITEMS core physics)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} ${PROJECT_BINARY_DIR}/generated/${folder}
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mpm OPTIONAL FILES_MATCHING PATTERN "*.hpp")
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/apps/mpm.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mpm/apps)

set(destination ${CMAKE_INSTALL_LIBDIR}/cmake/mpm)
install(EXPORT mpm FILE mpmTargets.cmake NAMESPACE mpm:: DESTINATION ${destination})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/mpmConfig.cmake.in ${PROJECT_BINARY_DIR}/mpmConfig.cmake
  INSTALL_DESTINATION ${destination} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/mpmConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/mpmConfig.cmake ${PROJECT_BINARY_DIR}/mpmConfigVersion.cmake
  DESTINATION ${destination})
