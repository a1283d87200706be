#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/scene/camera_path.h"

// The loader and image module: needs OpenMesh, tinygltf, nlohmann-json and OpenImageIO, which the core does not.
namespace rayengine {

/// Reads a scene by its extension: .json, .nff, .gltf, .glb, or a mesh (.obj .ply .stl .off), which gets the default
/// material, a framing camera and a headlight; every scene without camera or light gets those, and a note says so.
/// Throws Error with one line: what is wrong, file:line where there is one, what to do.
Scene load_scene(const std::filesystem::path& file);

/// One loader per format; load_scene chooses.
Scene load_json(const std::filesystem::path& file);
Scene load_nff(const std::filesystem::path& file);
Scene load_gltf(const std::filesystem::path& file);

/// Reads the keys of a camera's path: a JSON list of objects with `from`, `at`, `up` and `fov` as in a scene file's
/// camera, each what the key before has (the first, what `start` has) unless given, and `time`, one more than that of
/// the key before unless given. Throws Error with file:line, as for times that do not rise or fewer than two keys.
std::vector<CameraKey> load_camera_path(const std::filesystem::path& file, const Camera& start);

/// A mesh in file order: one triangle per face of three, fans for polygons, degenerate and non-manifold faces kept and
/// counted in `notes`. Positions keep the precision of the file.
Mesh load_mesh(const std::filesystem::path& file, std::vector<std::string>& notes);

}  // namespace rayengine
