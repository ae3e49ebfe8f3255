# Options every target of the project shares. Contraction is off so that CPU and GPU round alike.
add_library(grainray_options INTERFACE)
target_compile_options(grainray_options INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wshadow -Wno-unknown-pragmas -ffp-contract=off -fno-math-errno -fno-trapping-math -fopenmp-simd>
  $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CONFIG:Release>>:-O3>)
if(GRAINRAY_HAS_CUDA)
  target_compile_definitions(grainray_options INTERFACE GRAINRAY_HAS_CUDA)
  target_compile_options(grainray_options INTERFACE
    $<$<COMPILE_LANGUAGE:CUDA>:--extended-lambda --expt-relaxed-constexpr --fmad=false --diag-suppress=554>)
endif()
if(GRAINRAY_SANITIZE)
  target_compile_options(grainray_options INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${GRAINRAY_SANITIZE} -fno-omit-frame-pointer>)
  target_link_options(grainray_options INTERFACE -fsanitize=${GRAINRAY_SANITIZE})
endif()
