#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "gpu/device/await.h"
#include "gpu/device/objects.h"
#include "gpu/device_engine.h"

namespace rayengine {

/// The rays of one batch of the objects tracer, and its intersection stream: two textures, each pass reading the one
/// that the pass before it wrote.
class ObjectsBatch {
 public:
  /// `half` packs rays and hits into halves.
  ObjectsBatch(GLsizei side, bool half);

  std::size_t capacity() const { return static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_); }
  /// Uploads the rays, and clears the stream. The rest of the last row repeats old rays, whose answers nobody reads.
  void upload(std::span<const Traveller> travellers);
  /// Makes the stream's last output the input of the next pass, or of who reads it.
  void turn();
  /// Waits for the answers, after the last turn, and enters them. Throws Error when there is no hope of them, or they
  /// mean nothing.
  void read_back(std::span<Traveller> travellers, Context& context);

 private:
  void write(const Traveller& traveller, std::size_t i);
  void read(Traveller& traveller, std::size_t i) const;

  GLsizei side_, rows_ = 0;
  bool half_;
  std::vector<Texture> inputs_;
  MappedBuffer upload_, read_back_;
  std::array<Texture, 2> hits_;
  std::array<Framebuffer, 2> frames_{make_framebuffer(), make_framebuffer()};
  std::size_t output_ = 0;
};

}  // namespace rayengine
