# cmake --install: libraries, headers, the command and the package files that find_package(grainray) reads.
# Two export sets, so that whoever asks for the neighbour search alone needs oneTBB and Embree alone.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(GRAINRAY_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/grainray)

set_target_properties(grainray_neighbors grainray PROPERTIES
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} INSTALL_RPATH "$ORIGIN")
# `cmake --install --component neighbors` installs what the target grainray_neighbors alone has built.
install(TARGETS grainray_neighbors EXPORT grainrayNeighborsTargets
  ARCHIVE COMPONENT neighbors LIBRARY COMPONENT neighbors RUNTIME COMPONENT neighbors)
install(EXPORT grainrayNeighborsTargets NAMESPACE grainray:: DESTINATION ${GRAINRAY_PACKAGE_DIR} COMPONENT neighbors)
install(TARGETS grainray EXPORT grainraySimulationTargets)
install(EXPORT grainraySimulationTargets NAMESPACE grainray:: DESTINATION ${GRAINRAY_PACKAGE_DIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/grainray DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT neighbors)

if(TARGET grainray_cli)
  set_target_properties(grainray_cli PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS grainray_cli)
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/grainrayConfig.cmake.in ${PROJECT_BINARY_DIR}/grainrayConfig.cmake
  INSTALL_DESTINATION ${GRAINRAY_PACKAGE_DIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/grainrayConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/grainrayConfig.cmake ${PROJECT_BINARY_DIR}/grainrayConfigVersion.cmake
  DESTINATION ${GRAINRAY_PACKAGE_DIR} COMPONENT neighbors)
