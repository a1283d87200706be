#pragma once

#include <tiny_gltf.h>

#include <filesystem>

namespace rayengine {

/// Reads a .gltf or .glb file (told apart by their content) and its buffers, but no images. Throws Error, also when the
/// file needs an extension that is not read.
tinygltf::Model read_gltf_model(const std::filesystem::path& file);

}  // namespace rayengine
