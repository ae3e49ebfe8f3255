# cmake -D BUILD= -D PROJECT= -D WORK= -D GENERATOR= -D CXX= -D CONFIG= -P run.cmake
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
set(prefix "${WORK}/moved prefix")
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
file(RENAME ${WORK}/prefix ${prefix})
set(configure ${CMAKE_COMMAND} -G ${GENERATOR} -S ${PROJECT} -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_BUILD_TYPE=${CONFIG}
  -D CMAKE_PREFIX_PATH=${prefix})

# The neighbour search alone must not look for anything that only simulations need.
set(hidden "")
foreach(package fmt tomlplusplus ZLIB PNG HDF5)
  list(APPEND hidden -D CMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
run(${configure} -B ${WORK}/neighbors -D COMPONENTS=neighbors ${hidden})
run(${CMAKE_COMMAND} --build ${WORK}/neighbors)
run(${WORK}/neighbors/neighbors)

run(${configure} -B ${WORK}/everything)
run(${CMAKE_COMMAND} --build ${WORK}/everything)
run(${WORK}/everything/neighbors)
run(${WORK}/everything/simulation)

if(EXISTS "${prefix}/bin/grainray")
  run("${prefix}/bin/grainray" --version)
endif()
