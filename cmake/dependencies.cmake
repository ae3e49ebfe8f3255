# Every library the project needs, and one sentence with the apt line where something is missing.
set(GRAINRAY_MISSING_PACKAGES "")

# grainray_need(debian-package find_package-arguments...)
macro(grainray_need package name)
  find_package(${name} QUIET ${ARGN})
  if(NOT ${name}_FOUND)
    list(APPEND GRAINRAY_MISSING_PACKAGES ${package})
  endif()
endmacro()

# Call once after the last grainray_need of a directory.
function(grainray_check_missing)
  if(GRAINRAY_MISSING_PACKAGES)
    list(JOIN GRAINRAY_MISSING_PACKAGES " " packages)
    message(FATAL_ERROR "grainray: libraries are missing; install them with: sudo apt-get install ${packages}")
  endif()
endfunction()

grainray_need(libtbb-dev TBB)
grainray_need(libtomlplusplus-dev tomlplusplus)
grainray_need(libcli11-dev CLI11)
grainray_need(libfmt-dev fmt)
grainray_need(nlohmann-json3-dev nlohmann_json)
grainray_need(zlib1g-dev ZLIB)
grainray_need(libpng-dev PNG)
grainray_need(libhdf5-dev HDF5 COMPONENTS C)
grainray_need(libembree-dev embree)
grainray_check_missing()
