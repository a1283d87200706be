#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

// Reads the arrays of a glTF file. tinygltf takes a file's offsets and counts as they are, so that all of them are
// checked here. Errors name the accessor, not the file.
namespace rayengine {

/// An accessor of three components each; integers become floats as glTF says, normalised ones within [-1, 1].
std::vector<glm::dvec3> read_vectors(const tinygltf::Model& model, int accessor);

/// An accessor of unsigned scalars.
std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor);

}  // namespace rayengine
