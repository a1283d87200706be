#include "engine/load/load.h"

#include "accel/tracer.h"
#include "engine/load/complete.h"
#include "engine/load/text.h"

namespace rayengine {
namespace {

Scene scene_of_mesh(const std::filesystem::path& file) {
  Scene scene;
  GeometryBuilder builder;
  builder.add(load_mesh(file, scene.notes));
  scene.geometry = builder.build();
  complete(scene, false);
  return scene;
}

Scene dispatch(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  if (extension == ".json") return load_json(file);
  if (extension == ".nff") return load_nff(file);
  if (extension == ".gltf" || extension == ".glb") return load_gltf(file);
  for (const char* known : {".obj", ".ply", ".stl", ".off"})
    if (extension == known) return scene_of_mesh(file);
  throw Error(file.string() +
              ": is no kind of scene that can be read; use .json, .nff, .gltf, .glb, .obj, .ply, .stl or .off");
}

}  // namespace

Scene load_scene(const std::filesystem::path& file) {
  Scene scene = dispatch(file);
  if (scene.geometry->objects.empty())
    throw Error(file.string() + ": there is nothing to see; a scene needs an object");
  // What Embree takes as finite; beyond it single precision has no room left for squares.
  constexpr double farthest = 1e18;
  const Box bounds = finite_bounds(*scene.geometry);
  if (!bounds.empty() && bounds.extent() > farthest)
    throw Error(file.string() + ": reaches farther than 1e18; scale it down");
  return scene;
}

}  // namespace rayengine
