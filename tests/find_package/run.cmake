# cmake -D BUILD= -D SOURCE= -D PROJECT= -D WORK= -D GENERATOR= -D CXX= -D NVCC= -D CONFIG= -P run.cmake
# NVCC: where BUILD has CUDA; then a program in CUDA is built too, and the neighbour search once more without CUDA.
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# outside(folder prefix options...): configures and builds the outside project in a folder of WORK.
function(outside folder prefix)
  run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${PROJECT} -B ${WORK}/${folder} -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_BUILD_TYPE=${CONFIG}
    -D CMAKE_PREFIX_PATH=${prefix} ${ARGN})
  run(${CMAKE_COMMAND} --build ${WORK}/${folder})
  run(${WORK}/${folder}/neighbors)
endfunction()

# The neighbour search alone must not look for anything that only simulations need.
set(hidden "")
foreach(package fmt tomlplusplus ZLIB PNG HDF5 assimp)
  list(APPEND hidden -D CMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()

file(REMOVE_RECURSE ${WORK})
set(prefix "${WORK}/moved prefix")
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
file(RENAME ${WORK}/prefix ${prefix})

if(NVCC)
  outside(neighbors ${prefix} -D COMPONENTS=neighbors ${hidden} -D CUDA=ON -D CMAKE_CUDA_COMPILER=${NVCC} -D CMAKE_CUDA_ARCHITECTURES=75)
  run(${WORK}/neighbors/pointers)
else()
  outside(neighbors ${prefix} -D COMPONENTS=neighbors ${hidden})
endif()
outside(everything ${prefix})
run(${WORK}/everything/simulation)
if(EXISTS "${prefix}/bin/grainray")
  run("${prefix}/bin/grainray" --version)
endif()

# Only the neighbour search, built and installed by itself, without CUDA, by a compiler that has nvcc beside it.
if(NVCC)
  run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE} -B ${WORK}/build -D CMAKE_CXX_COMPILER=${CXX} -D CMAKE_BUILD_TYPE=${CONFIG}
    -D GRAINRAY_CUDA=OFF -D GRAINRAY_TESTS=OFF)
  run(${CMAKE_COMMAND} --build ${WORK}/build --target grainray_neighbors)
  run(${CMAKE_COMMAND} --install ${WORK}/build --component neighbors --prefix ${WORK}/cpu)
  outside(without_cuda ${WORK}/cpu -D COMPONENTS=neighbors ${hidden} -D CMAKE_DISABLE_FIND_PACKAGE_CUDAToolkit=ON)
endif()
