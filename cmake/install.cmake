# What `cmake --install` gives: the core's headers and library, its CMake and pkg-config packages, the command, the scenes.
include(CMakePackageConfigHelpers)
set(header_folder ${CMAKE_INSTALL_INCLUDEDIR}/rayengine)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/RayEngine)

# What a host may include: all that rayengine.h names, comparisons, and the kernels for those who trace by themselves.
foreach(header accel/box.h accel/geometry.h accel/quadric.h accel/ray.h accel/surface.h accel/tracer.h accel/transform.h
    engine/measure/compare.h engine/plan/device.h engine/plan/model.h engine/plan/plan.h engine/plan/planned.h
    engine/plan/recognise/recognise.h
    engine/plan/statistics.h engine/plan/verify.h engine/render/render.h engine/scene/image.h engine/scene/pixels.h
    engine/scene/scene.h engine/tracers.h)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${header} DESTINATION ${header_folder}/${folder})
endforeach()
install(DIRECTORY accel/kernels DESTINATION ${header_folder}/accel)
install(FILES engine/rayengine.h DESTINATION ${header_folder})

# Here headers include each other from the top folder. In a host's include path "engine/..." could be the host's own.
install(CODE "set(headers \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${header_folder}\")")
install(CODE [[
  file(GLOB_RECURSE headers "${headers}/*.h")
  foreach(header ${headers})
    file(READ "${header}" text)
    string(REGEX REPLACE "#include \"(accel|engine)/" "#include \"rayengine/\\1/" text "${text}")
    file(WRITE "${header}" "${text}")
  endforeach()
]])

install(TARGETS rayengine EXPORT RayEngineTargets)
install(EXPORT RayEngineTargets NAMESPACE RayEngine:: DESTINATION ${package_folder})
write_basic_package_version_file(RayEngineConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/RayEngineConfig.cmake ${PROJECT_BINARY_DIR}/RayEngineConfigVersion.cmake DESTINATION ${package_folder})

set(pkgconfig_folder ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH pkgconfig_to_prefix /${pkgconfig_folder} /)
configure_file(cmake/rayengine.pc.in rayengine.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/rayengine.pc DESTINATION ${pkgconfig_folder})

if(RAYENGINE_TOOLS)
  install(TARGETS rayengine_cli)
  install(TARGETS rayengine_images LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/rayengine)
endif()
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/rayengine)
