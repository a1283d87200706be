option(RAYENGINE_UNITY "Compile sources eight at a time" OFF)

# What eight sources instantiate alike is compiled once for them: for builds from nothing, whose every source is compiled.
# Names in their unnamed namespaces must differ then, which the sources of the others here need not heed.
function(unite target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${RAYENGINE_UNITY} UNITY_BUILD_BATCH_SIZE 8)
endfunction()
