#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "accel/tracer.h"
#include "engine/load/face_list.h"
#include "engine/load/load.h"
#include "engine/load/mesh_check.h"
#include "engine/load/text.h"
#include "engine/load/weld.h"

namespace rayengine {
namespace {

FaceList read_faces(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  if (extension == ".obj") return read_obj(read_file(file), file);
  if (extension == ".ply") return read_ply(read_file(file), file);
  if (extension == ".stl") return read_stl(read_file(file), file);
  if (extension == ".off") return read_off(read_file(file), file);
  throw Error(file.string() + ": is not a mesh that can be read; use .obj, .ply, .stl or .off");
}

// A normal that is not finite or has no length says nothing: zero, which means the flat one.
glm::vec3 unit_or_zero(const glm::vec3& n) {
  const glm::dvec3 d(n);
  const double length = std::sqrt(glm::dot(d, d));
  return std::isfinite(length) && length > 0 ? glm::vec3(d / length) : glm::vec3(0);
}

/// Gives every vertex one normal, where the file gives one to each corner of a face: a vertex whose corners disagree is
/// copied to the end, once for each further normal.
class NormalSplit {
 public:
  explicit NormalSplit(FaceList& list) : list_(list), normal_of_(list.positions.size(), unused) {}

  void run() {
    number_equal_normals();
    for (std::size_t t = 0; t < list_.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t n = list_.triangle_normals[t][k];
        std::uint32_t& vertex = list_.triangles[t][k];
        vertex = vertex_with(vertex, n == no_id ? no_id : number_[n]);
      }
    std::vector<glm::vec3> normals(list_.positions.size(), glm::vec3(0));
    for (std::size_t v = 0; v < normals.size(); ++v)
      if (normal_of_[v] < unused) normals[v] = list_.normals[normal_of_[v]];
    list_.normals = std::move(normals);
  }

 private:
  static constexpr std::uint32_t unused = no_id - 1;

  // Many files repeat a normal for each face; equal ones must not split their vertex.
  void number_equal_normals() {
    Weld weld(list_.normals.size());
    std::size_t kept = 0;
    for (const glm::vec3& n : list_.normals) {
      const auto [number, is_new] = weld.add(glm::dvec3(n));
      if (is_new) list_.normals[kept++] = n;
      number_.push_back(number);
    }
    list_.normals.resize(kept);
  }

  std::uint32_t vertex_with(std::uint32_t vertex, std::uint32_t normal) {
    if (normal_of_[vertex] == unused) normal_of_[vertex] = normal;
    if (normal_of_[vertex] == normal) return vertex;
    const auto next = static_cast<std::uint32_t>(list_.positions.size());
    const auto [copy, is_new] = copies_.try_emplace(std::uint64_t{vertex} << 32 | normal, next);
    if (is_new) {
      if (next >= max_vertices) throw Error("more vertices than 32-bit indices can name; drop its normals");
      list_.positions.push_back(list_.positions[vertex]);
      normal_of_.push_back(normal);
    }
    return copy->second;
  }

  FaceList& list_;
  std::vector<std::uint32_t> number_;     // of the normals of the file
  std::vector<std::uint32_t> normal_of_;  // by vertex: a normal, none (no_id), or unused as yet
  std::unordered_map<std::uint64_t, std::uint32_t> copies_;
};

void describe(const FaceList& list, const std::string& file, std::vector<std::string>& notes) {
  const std::string defects = to_string(find_defects(list.positions, list.triangles));
  if (!defects.empty()) notes.push_back(file + ": " + defects + "; all kept");
  if (list.faces_without_area)
    notes.push_back(file + ": " + std::to_string(list.faces_without_area) +
                    " faces of fewer than three corners passed over");
  if (list.has_materials) notes.push_back(file + ": its materials are not used");
}

}  // namespace

Mesh load_mesh(const std::filesystem::path& file, std::vector<std::string>& notes) {
  FaceList list = read_faces(file);
  if (list.triangles.empty()) throw Error(file.string() + ": holds no triangles; is it a mesh?");
  describe(list, file.string(), notes);
  for (glm::vec3& n : list.normals) n = unit_or_zero(n);
  if (!list.triangle_normals.empty()) NormalSplit(list).run();
  return {std::move(list.positions), std::move(list.normals), std::move(list.triangles)};
}

}  // namespace rayengine
