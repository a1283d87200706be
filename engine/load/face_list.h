#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "accel/ray.h"

// What the readers of mesh files hand on: the faces just as the file lists them.
//
// OpenMesh 9 has readers for the same formats, but they are of no use here: all four parse coordinates to float (0.1
// comes back as 0.10000000149 even into a mesh of doubles), the one for STL drops facets of no area, so that later ones
// change their number, and none checks a count or an index of the file against anything.
namespace rayengine {

struct FaceList {
  std::vector<glm::dvec3> positions;
  std::vector<glm::uvec3> triangles;         ///< polygons cut as fans, in file order
  std::vector<glm::vec3> normals;            ///< one per position or none, unless `triangle_normals` indexes them
  std::vector<glm::uvec3> triangle_normals;  ///< one per triangle or none; no_id where a corner has no normal
  std::uint64_t faces_without_area = 0;      ///< faces of fewer than three corners, which make no triangle
  bool has_materials = false;                ///< the file names materials
};

/// Cuts one polygon into a fan while its corners arrive.
class Fan {
 public:
  explicit Fan(FaceList& list) : list_(list) {}
  ~Fan() { list_.faces_without_area += corners_ < 3; }
  Fan(const Fan&) = delete;
  Fan& operator=(const Fan&) = delete;

  void add(std::uint32_t position) {
    if (corners_ >= 2) list_.triangles.emplace_back(first_, previous_, position);
    if (corners_++ == 0) first_ = position;
    previous_ = position;
  }

  void add(std::uint32_t position, std::uint32_t normal) {
    if (corners_ >= 2) list_.triangle_normals.emplace_back(first_normal_, previous_normal_, normal);
    if (corners_ == 0) first_normal_ = normal;
    previous_normal_ = normal;
    add(position);
  }

 private:
  FaceList& list_;
  std::uint64_t corners_ = 0;
  std::uint32_t first_ = 0, previous_ = 0;
  std::uint32_t first_normal_ = no_id, previous_normal_ = no_id;
};

/// One reader per format. `data` is the file's content; `file` is for messages. They throw Error on what is not sound:
/// counts beyond the file's size, indices out of range, coordinates that are not finite.
FaceList read_obj(std::string_view data, const std::filesystem::path& file);
FaceList read_ply(std::string_view data, const std::filesystem::path& file);
FaceList read_stl(std::string_view data, const std::filesystem::path& file);
FaceList read_off(std::string_view data, const std::filesystem::path& file);

/// The most vertices that 32-bit indices can name, one value being kept for "none".
inline constexpr std::uint64_t max_vertices = 0xFFFFFFFEu;

}  // namespace rayengine
