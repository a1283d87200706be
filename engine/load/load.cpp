#include "engine/load/load.h"

#include <algorithm>
#include <cctype>

#include "engine/load/complete.h"
#include "engine/load/place.h"

namespace rayengine {
namespace {

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

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
  throw Error("unknown kind of scene " + in_quotes(file.filename().string()) +
              ": name a .json, .nff, .gltf, .glb, .obj, .ply, .stl or .off file");
}

}  // namespace

Scene load_scene(const std::filesystem::path& file) {
  Scene scene = dispatch(file);
  if (scene.geometry->objects.empty())
    throw Error("there is nothing to see in " + file.string() + ": a scene needs an object");
  // What Embree takes as finite; beyond it single precision has no room left for squares.
  constexpr double farthest = 1e18;
  if (scene.geometry->bounds.finite() && scene.geometry->bounds.extent() > farthest)
    throw Error(file.string() + " reaches beyond 1e18: scale it down");
  return scene;
}

}  // namespace rayengine
