#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

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

/// A mesh in file order: one triangle per face of three, fans for polygons, degenerate and non-manifold faces kept and
/// counted in `notes`. Positions keep the precision of the file.
Mesh load_mesh(const std::filesystem::path& file, std::vector<std::string>& notes);

}  // namespace rayengine
