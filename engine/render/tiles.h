#pragma once

#include <vector>

#include "engine/render/camera.h"
#include "engine/render/render.h"
#include "engine/render/sampling.h"
#include "engine/render/waves.h"

namespace rayengine {

/// How a picture is cut: into squares of pixels, so that one wave of primary rays fills a batch.
struct Tiling {
  glm::ivec2 size;  ///< of the picture
  int side;         ///< of a tile, a power of two
  int pass;         ///< samples of a pixel in one wave

  /// `batch` rays per wave at most, but never tiles below 8x8 pixels, which waste coherence.
  Tiling(const glm::ivec2& size, int spp, std::size_t batch);

  std::vector<glm::ivec2> order;  ///< the pixels of a tile, in Morton order: neighbours both ways follow each other

  int columns() const { return (size.x + side - 1) / side; }
  int rows() const { return (size.y + side - 1) / side; }
  std::size_t count() const { return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()); }
  /// Appends the pixels of a tile.
  void pixels(std::size_t tile, std::vector<glm::ivec2>& result) const;
};

/// One thread's renderer: any tile, one after another, in buffers of its own.
class TileRenderer {
 public:
  TileRenderer(const Picture& picture, const CameraFrame& camera, const PixelSampler& sampler, const Tiling& tiling,
               const RenderOptions& options, const TracerGate& gate)
      : picture_(picture),
        camera_(camera),
        sampler_(sampler),
        tiling_(tiling),
        options_(options),
        gate_(gate),
        waves_(picture, gate_) {}
  TileRenderer(const TileRenderer&) = delete;

  /// Writes the tile's pixels of `image`, whose first channels are R G B A and those after it the AOVs'.
  void render(std::size_t tile, Image& image);

  /// Adds what this thread has done so far.
  void add_to(RenderStats& stats) const;

 private:
  void start(Ray& ray, const glm::ivec2& pixel, const glm::dvec2& offset) const;
  void sample(int first, int last);
  void write_colors(Image& image) const;
  void trace_aovs(Image& image);

  const Picture& picture_;
  const CameraFrame& camera_;
  const PixelSampler& sampler_;
  const Tiling& tiling_;
  const RenderOptions& options_;
  TracerGate gate_;
  Waves waves_;
  std::vector<glm::ivec2> pixels_;
  std::vector<glm::dvec3> colors_;  ///< sums over samples
  std::vector<Ray> aov_rays_;
  std::vector<Hit> aov_hits_;
  std::uint64_t aov_ray_count_ = 0;
  double seconds_ = 0;
};

}  // namespace rayengine
