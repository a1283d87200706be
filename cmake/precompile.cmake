option(RAYENGINE_PRECOMPILE "Precompile headers of the standard library and of others" ON)

# Headers of others that most sources of a target read are parsed once for all of them. Our own stay out, so that a change to
# one rebuilds what it must and no more. Not under ccache, which would find less; builds under it prove that every source
# includes what it uses.
function(precompile target)
  if(RAYENGINE_PRECOMPILE AND NOT CMAKE_CXX_COMPILER_LAUNCHER MATCHES ccache)
    set(headers algorithm array cmath functional glm/geometric.hpp glm/matrix.hpp memory optional span string vector ${ARGN})
    list(TRANSFORM headers REPLACE "(.+)" "<\\1>")
    target_precompile_headers(${target} PRIVATE ${headers})
  endif()
endfunction()

# The same for what is optimised as far as it goes in a release, where g++ 12 would warn of strings of its own library.
function(precompile_optimised target)
  if(NOT CMAKE_BUILD_TYPE STREQUAL Release)
    precompile(${target} ${ARGN})
  endif()
endfunction()
