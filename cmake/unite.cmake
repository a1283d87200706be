option(RAYENGINE_UNITY "Compile sources eight at a time" OFF)

# For builds from nothing: what eight sources instantiate alike is compiled once. Names in the unnamed namespaces of neighbours
# must differ then.
function(unite target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${RAYENGINE_UNITY} UNITY_BUILD_BATCH_SIZE 8)
endfunction()
