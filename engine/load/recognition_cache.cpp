#include "engine/load/recognition_cache.h"

#include <algorithm>

#include "engine/load/mesh_files.h"

namespace rayengine {
namespace {

struct Way {
  char format[8] = {'R', 'a', 'y', 'Q', 'u', 'a', '0', '1'};
  double tolerance;
  std::uint64_t pieces;
};

/// Followed by quadrics, and the triangles that stay.
struct RecognitionHeader {
  std::uint64_t quadrics = 0, rest = 0;
};

/// A quadric as it is kept.
struct Kept {
  std::uint32_t type = 0;
  bool capped = false, has_clip = false, has_matrix = false, has_box = false;
  std::array<double, 2> clip{};
  QuadricMatrix matrix{};
  Box box;
  Affine to_world;
  double residual = 0;
};
static_assert(std::is_trivially_copyable_v<Kept> && sizeof(Kept) == 8 + 8 * (2 + 10 + 6 + 12 + 1), "no padding");

Kept to_kept(const RecognisedQuadric& q) {
  return {static_cast<std::uint32_t>(q.shape.type),
          q.shape.capped,
          q.shape.clip.has_value(),
          q.shape.matrix.has_value(),
          q.shape.box.has_value(),
          q.shape.clip.value_or(std::array<double, 2>{}),
          q.shape.matrix.value_or(QuadricMatrix{}),
          q.shape.box.value_or(Box{}),
          q.to_world,
          q.residual};
}

RecognisedQuadric from_kept(const Kept& k) {
  RecognisedQuadric q{{static_cast<QuadricType>(k.type), k.capped, {}, {}, {}}, k.to_world, {}, k.residual};
  if (k.has_clip) q.shape.clip = k.clip;
  if (k.has_matrix) q.shape.matrix = k.matrix;
  if (k.has_box) q.shape.box = k.box;
  return q;
}

std::filesystem::path file_of(const Mesh& mesh, double tolerance, Pieces pieces) {
  const Way way{.tolerance = tolerance, .pieces = static_cast<std::uint64_t>(pieces)};
  return mesh_file(mesh, bytes_of(way), ".quadrics");
}

std::optional<Recognition> find(const std::filesystem::path& file, std::size_t triangles) {
  const auto content = read_mesh_file(file);
  if (!content) return {};
  MeshFileReader reader(*content);
  RecognitionHeader header;
  std::vector<Kept> kept;
  Recognition found;
  if (!reader.read(header) || !reader.read(kept, header.quadrics) || !reader.read(found.rest, header.rest) ||
      !reader.at_end())
    return {};
  if (std::ranges::any_of(kept, [](const Kept& k) { return k.type >= quadric_type_count; })) return {};
  if (std::ranges::any_of(found.rest, [&](std::uint32_t t) { return t >= triangles; })) return {};
  for (const Kept& k : kept) found.quadrics.push_back(from_kept(k));
  return found;
}

}  // namespace

std::optional<Recognition> find_recognised(const Mesh& mesh, double tolerance, Pieces pieces) {
  return find(file_of(mesh, tolerance, pieces), mesh.triangles.size());
}

Recognition recognise_cached(const Mesh& mesh, double tolerance, Pieces pieces) {
  const std::filesystem::path file = file_of(mesh, tolerance, pieces);
  if (auto found = find(file, mesh.triangles.size())) return *std::move(found);
  Recognition result = recognise(mesh, tolerance, pieces);
  std::vector<Kept> kept;
  for (const RecognisedQuadric& q : result.quadrics) kept.push_back(to_kept(q));
  write_mesh_file(
      file, {bytes_of(RecognitionHeader{kept.size(), result.rest.size()}), bytes_of(kept), bytes_of(result.rest)});
  return result;
}

}  // namespace rayengine
