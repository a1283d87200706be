option(RAYENGINE_PRECOMPILE "Precompile headers of the standard library and of others" ON)

# Headers of others that most sources of a target read are parsed once for all of them. Our own stay out, so that a change to
# one rebuilds what it must and no more. Not under ccache, which would find less; builds under it prove that every source
# includes what it uses. With them g++ 12 takes its library's own strings to be too short, where it optimises.
function(precompile target)
  if(RAYENGINE_PRECOMPILE AND NOT CMAKE_CXX_COMPILER_LAUNCHER MATCHES ccache)
    set(headers algorithm array cmath functional glm/geometric.hpp glm/matrix.hpp memory optional span string vector ${ARGN})
    list(TRANSFORM headers REPLACE "(.+)" "<\\1>")
    target_precompile_headers(${target} PRIVATE ${headers})
    target_compile_options(${target} PRIVATE
      $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-restrict -Wno-stringop-overread -Wno-stringop-overflow>)
  endif()
endfunction()
