#include "gpu/scene/scene_textures.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <span>
#include <string>

#include "accel/tracer.h"

namespace rayengine {
namespace {

using Texel = std::array<std::uint32_t, 4>;

std::uint32_t bits(double a) { return std::bit_cast<std::uint32_t>(static_cast<float>(a)); }

/// Infinite sides become numbers that arithmetic cannot turn into NaN.
std::uint32_t finite_bits(double a) { return bits(std::clamp(a, -1e37, 1e37)); }

/// Three texels: the corners, and in the first one's w the rank.
void append_triangle(std::vector<Texel>& to, const FlatScene& scene, const LocalFrame& frame, std::uint32_t triangle) {
  for (int corner = 0; corner < 3; ++corner) {
    const glm::dvec3 p =
        (scene.geometry->vertex(scene.geometry->triangles[triangle][corner]) - frame.center) * frame.scale;
    to.push_back({bits(p.x), bits(p.y), bits(p.z), corner == 0 ? scene.triangle_ranks[triangle] : 0});
  }
}

/// Four texels: the rows of the map from the frame to object space, each with a component of its origin; then the clip
/// planes, the rank, and the index of a general form or whether there are caps. Where all spheres are `balls` theirs
/// have y and z of the origin in place of the clip planes, so that the kernel reads two texels.
void append_quadric(std::vector<Texel>& to, const FlatScene& scene, const LocalFrame& frame, bool balls,
                    std::uint32_t quadric) {
  const Quadric& q = scene.geometry->quadrics[quadric];
  const glm::dmat3 linear = q.to_object.linear / frame.scale;
  const glm::dvec3 origin = (q.to_object.origin - frame.center) * frame.scale;
  for (int row = 0; row < 3; ++row)
    to.push_back({bits(linear[0][row]), bits(linear[1][row]), bits(linear[2][row]), bits(origin[row])});
  if (balls && q.type == QuadricType::sphere) {
    to.push_back({bits(origin.y), bits(origin.z), scene.quadric_ranks[quadric], 0});
    return;
  }
  const std::uint32_t extra = q.type == QuadricType::general ? q.form : q.capped;
  to.push_back({finite_bits(q.zmin), finite_bits(q.zmax), scene.quadric_ranks[quadric], extra});
}

/// Four texels: the ten coefficients, then the box.
void append_form(std::vector<Texel>& to, const GeneralForm& form) {
  std::array<std::uint32_t, 16> all;
  std::transform(form.matrix.begin(), form.matrix.end(), all.begin(), bits);
  for (int i = 0; i < 3; ++i) {
    all[static_cast<std::size_t>(10 + i)] = finite_bits(form.box.lower[i]);
    all[static_cast<std::size_t>(13 + i)] = finite_bits(form.box.upper[i]);
  }
  for (std::size_t i = 0; i < 16; i += 4) to.push_back({all[i], all[i + 1], all[i + 2], all[i + 3]});
}

std::uint32_t type_of(const Quadric& q) { return static_cast<std::uint32_t>(q.type); }

std::vector<KernelType> types_in(const Geometry& g) {
  std::vector<KernelType> types;
  if (!g.triangles.empty()) types.push_back(TreeletPrimitive::triangle);
  TraitsByType traits{};
  add_traits(traits, g.quadrics);
  for (std::uint32_t i = 0; i < traits.size(); ++i) {
    const QuadricTraits& t = traits[i];
    if (t.any) types.push_back({i, t.clipped, t.capped, t.balls});
  }
  return types;
}

bool all_balls(const std::vector<KernelType>& types) {
  const auto spheres = std::find(types.begin(), types.end(), static_cast<std::uint32_t>(QuadricType::sphere));
  return spheres != types.end() && spheres->balls;
}

/// First primitive and count for every type of every treelet, then of those without bounds, then of none.
std::vector<std::array<std::uint32_t, 2>> ranges_of(const Geometry& g, const Treelets& treelets,
                                                    const std::vector<KernelType>& types) {
  std::vector<std::array<std::uint32_t, 2>> ranges;
  const auto append = [&](const Treelet& t) {
    const auto first = treelets.quadrics.begin() + t.first_quadric, last = first + t.quadric_count;
    for (const KernelType type : types) {
      if (type == TreeletPrimitive::triangle) {
        ranges.push_back({t.first_triangle, t.triangle_count});
        continue;
      }
      const auto begin =
          std::partition_point(first, last, [&](auto q) { return type_of(g.quadrics[q]) < type.primitive; });
      const auto end = std::partition_point(begin, last, [&](auto q) { return type == type_of(g.quadrics[q]); });
      ranges.push_back(
          {static_cast<std::uint32_t>(begin - treelets.quadrics.begin()), static_cast<std::uint32_t>(end - begin)});
    }
  };
  for (const Treelet& t : treelets.treelets) append(t);
  append(treelets.unbounded);
  append({});
  return ranges;
}

SceneTextures upload_primitives(const FlatScene& scene, const LocalFrame& frame,
                                std::span<const std::uint32_t> triangle_order,
                                std::span<const std::uint32_t> quadric_order, const GpuInfo& gpu) {
  require_texels(3 * triangle_order.size(), "triangles", gpu);
  require_texels(4 * quadric_order.size(), "quadrics", gpu);
  require_texels(4 * scene.geometry->forms.size(), "general forms", gpu);
  std::vector<Texel> triangles, quadrics, forms;
  triangles.reserve(3 * triangle_order.size());
  quadrics.reserve(4 * quadric_order.size());
  for (const std::uint32_t i : triangle_order) append_triangle(triangles, scene, frame, i);
  SceneTextures result;
  result.types = types_in(*scene.geometry);
  const bool balls = all_balls(result.types);
  for (const std::uint32_t i : quadric_order) append_quadric(quadrics, scene, frame, balls, i);
  for (const GeneralForm& form : scene.geometry->forms) append_form(forms, form);
  result.triangles = make_buffer_texture(GL_RGBA32UI, triangles);
  result.quadrics = make_buffer_texture(GL_RGBA32UI, quadrics);
  result.forms = make_buffer_texture(GL_RGBA32UI, forms);
  result.bytes = result.triangles.buffer.bytes + result.quadrics.buffer.bytes + result.forms.buffer.bytes;
  return result;
}

}  // namespace

void require_texels(std::size_t texels, const char* what, const GpuInfo& gpu) {
  if (texels > static_cast<std::size_t>(gpu.buffer_texels))
    throw Error(std::string("the scene's ") + what + " need " + std::to_string(texels) +
                " texels, more than the GPU's " + std::to_string(gpu.buffer_texels) + "; use --tracer embree");
}

void SceneTextures::bind() const {
  triangles.bind(triangles_unit);
  quadrics.bind(quadrics_unit);
  forms.bind(forms_unit);
}

BufferTexture upload_ranges(const Geometry& geometry, const Treelets& treelets, const std::vector<KernelType>& types,
                            const GpuInfo& gpu) {
  require_texels((treelets.treelets.size() + 2) * types.size(), "treelets", gpu);
  return make_buffer_texture(GL_RG32UI, ranges_of(geometry, treelets, types));
}

SceneTextures upload(const FlatScene& scene, const Treelets& treelets, const GpuInfo& gpu) {
  SceneTextures result = upload_primitives(scene, treelets.frame, treelets.triangles, treelets.quadrics, gpu);
  result.ranges = upload_ranges(*scene.geometry, treelets, result.types, gpu);
  result.bytes += result.ranges.buffer.bytes;
  return result;
}

SceneTextures upload(const FlatScene& scene, const LocalFrame& frame, const GpuInfo& gpu) {
  std::vector<std::uint32_t> triangles(scene.geometry->triangles.size()), quadrics(scene.geometry->quadrics.size());
  std::iota(triangles.begin(), triangles.end(), 0u);
  std::iota(quadrics.begin(), quadrics.end(), 0u);
  return upload_primitives(scene, frame, triangles, quadrics, gpu);
}

}  // namespace rayengine
