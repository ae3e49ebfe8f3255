# cmake -D PROGRAMS= -D SOURCE= -D FOLDER= -D TESTS= -D STRIP= -P package_folder.cmake
# Not carried: the C and C++ runtime, which every system has and must be as new as the building one's, and the driver.
cmake_policy(VERSION 3.22)
file(REMOVE_RECURSE ${FOLDER})
file(INSTALL ${PROGRAMS} DESTINATION ${FOLDER}/bin USE_SOURCE_PERMISSIONS)
file(GLOB copies ${FOLDER}/bin/*)
execute_process(COMMAND ${STRIP} ${copies} COMMAND_ERROR_IS_FATAL ANY)

file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${PROGRAMS}
  RESOLVED_DEPENDENCIES_VAR libraries UNRESOLVED_DEPENDENCIES_VAR missing CONFLICTING_DEPENDENCIES_PREFIX conflict
  PRE_EXCLUDE_REGEXES "^ld-linux" "^lib(c|m|dl|rt|pthread|resolv|stdc\\+\\+|gcc_s)\\.so")
if(missing)
  message(FATAL_ERROR "grainray: the package would lack ${missing}")
endif()
file(INSTALL ${libraries} DESTINATION ${FOLDER}/lib FOLLOW_SYMLINK_CHAIN)

# Licences, where dpkg knows whose file a library is. (It may know it by another folder: /lib is a link to /usr/lib.)
find_program(DPKG_QUERY dpkg-query)
if(DPKG_QUERY)
  foreach(library ${libraries})
    file(REAL_PATH ${library} real)
    get_filename_component(name ${real} NAME)
    execute_process(COMMAND ${DPKG_QUERY} -S "*/${name}" OUTPUT_VARIABLE owner ERROR_QUIET)
    if(owner MATCHES "^([^:]+):")
      file(INSTALL /usr/share/doc/${CMAKE_MATCH_1}/copyright DESTINATION ${FOLDER}/licences RENAME ${CMAKE_MATCH_1} FOLLOW_SYMLINK_CHAIN)
    endif()
  endforeach()
endif()

file(INSTALL ${SOURCE}/README.md ${SOURCE}/LICENSE ${SOURCE}/CHANGELOG.md ${SOURCE}/examples DESTINATION ${FOLDER})
file(INSTALL ${SOURCE}/docs/scene.md DESTINATION ${FOLDER}/docs)
if(TESTS)
  file(INSTALL ${SOURCE}/tools/run_tests.sh DESTINATION ${FOLDER} USE_SOURCE_PERMISSIONS)
endif()
