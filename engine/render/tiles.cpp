#include "engine/render/tiles.h"

#include <algorithm>

#include "accel/stopwatch.h"
#include "engine/render/aov.h"

namespace rayengine {
namespace {

constexpr int smallest_side = 8;
constexpr int rgba = 4;

/// The even bits of a number, moved together.
int even_bits(std::uint32_t morton) {
  int result = 0;
  for (int bit = 0; bit < 16; ++bit) result |= static_cast<int>(morton >> (2 * bit) & 1u) << bit;
  return result;
}

std::size_t square(int side) { return static_cast<std::size_t>(side) * static_cast<std::size_t>(side); }

}  // namespace

Tiling::Tiling(const glm::ivec2& size, int spp, std::size_t batch) : size(size), side(smallest_side) {
  const auto samples = static_cast<std::size_t>(spp);
  while (square(2 * side) * samples <= batch && side < std::max(size.x, size.y)) side *= 2;
  pass = static_cast<int>(std::clamp<std::size_t>(batch / square(side), 1, samples));
  for (std::uint32_t i = 0; i < square(side); ++i) order.emplace_back(even_bits(i), even_bits(i >> 1));
}

void Tiling::pixels(std::size_t tile, std::vector<glm::ivec2>& result) const {
  const auto across = static_cast<std::size_t>(columns());
  const glm::ivec2 corner = side * glm::ivec2(tile % across, tile / across);
  for (const glm::ivec2& offset : order)
    if (const glm::ivec2 p = corner + offset; p.x < size.x && p.y < size.y) result.push_back(p);
}

void TileRenderer::start(Ray& ray, const glm::ivec2& pixel, const glm::dvec2& offset) const {
  camera_.start(ray, pixel.x + 0.5 + offset.x, pixel.y + 0.5 + offset.y);
}

void TileRenderer::sample(int first, int last) {
  Ray* out = waves_.primary(pixels_.size() * static_cast<std::size_t>(last - first)).data();
  for (const glm::ivec2& p : pixels_)
    for (int s = first; s < last; ++s) start(*out++, p, sampler_.offset(p.x, p.y, s));
  const glm::vec3* seen = waves_.radiance().data();
  for (glm::dvec3& color : colors_)
    for (int s = first; s < last; ++s) color += *seen++;
}

void TileRenderer::write_colors(Image& image) const {
  const double share = 1.0 / options_.spp;
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    float* out = image.pixel(pixels_[i].x, pixels_[i].y);
    for (int c = 0; c < 3; ++c) out[c] = static_cast<float>(colors_[i][c] * share);
    out[3] = 1;
  }
}

void TileRenderer::trace_aovs(Image& image) {
  aov_rays_.clear();
  for (const glm::ivec2& p : pixels_) start(aov_rays_.emplace_back(), p, {0, 0});
  aov_hits_.resize(aov_rays_.size());
  gate_.closest(aov_rays_, aov_hits_, RayClass::primary);
  aov_ray_count_ += aov_rays_.size();
  for (std::size_t i = 0; i < pixels_.size(); ++i)
    write_aovs(options_.aovs, picture_.geometry, aov_rays_[i], aov_hits_[i],
               object_number(picture_.object_numbers, aov_hits_[i].object),
               image.pixel(pixels_[i].x, pixels_[i].y) + rgba);
}

void TileRenderer::render(std::size_t tile, Image& image) {
  const Stopwatch watch;
  pixels_.clear();
  tiling_.pixels(tile, pixels_);
  colors_.assign(pixels_.size(), glm::dvec3(0));
  for (int s = 0; s < options_.spp; s += tiling_.pass) sample(s, std::min(s + tiling_.pass, options_.spp));
  write_colors(image);
  if (!options_.aovs.empty()) trace_aovs(image);
  seconds_ += watch.seconds();
}

void TileRenderer::add_to(RenderStats& stats) const {
  for (std::size_t i = 0; i < stats.rays.size(); ++i) stats.rays[i] += waves_.rays()[i];
  stats.rays[0] += aov_ray_count_;
  stats.invalid_rays += waves_.invalid_rays();
  stats.tracer_seconds += gate_.tracer_seconds();
  stats.shading_seconds += seconds_ - gate_.tracer_seconds() - gate_.waiting_seconds();
}

}  // namespace rayengine
