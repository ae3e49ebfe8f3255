# The target package_folder: build/package/grainray-<version>-<system>-<processor>/ with the programs, every library they
# need beyond the C and C++ runtime, the licences of those libraries, and the examples; and the same as .tar.gz. The preset `package` builds it.
set(folder grainray-${PROJECT_VERSION}-${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR})
string(TOLOWER ${folder} folder)

set(programs grainray_cli)
if(GRAINRAY_TESTS)
  get_property(parts DIRECTORY tests PROPERTY SUBDIRECTORIES)
  foreach(part ${parts})
    get_property(targets DIRECTORY ${part} PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target ${targets})
      get_target_property(type ${target} TYPE)
      if(type STREQUAL EXECUTABLE)
        list(APPEND programs ${target})
      endif()
    endforeach()
  endforeach()
endif()

set(files "")
foreach(program ${programs})
  list(APPEND files $<TARGET_FILE:${program}>)
endforeach()
add_custom_target(package_folder
  COMMAND ${CMAKE_COMMAND} -D "PROGRAMS=${files}" -D SOURCE=${PROJECT_SOURCE_DIR} -D FOLDER=${PROJECT_BINARY_DIR}/${folder}
    -D TESTS=${GRAINRAY_TESTS} -D STRIP=${CMAKE_STRIP} -P ${PROJECT_SOURCE_DIR}/cmake/package_folder.cmake
  COMMAND ${CMAKE_COMMAND} -E tar czf ${folder}.tar.gz ${folder}
  WORKING_DIRECTORY ${PROJECT_BINARY_DIR} DEPENDS ${programs} VERBATIM COMMENT "Gathering ${folder}")
