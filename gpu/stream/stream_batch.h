#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "gpu/device/await.h"
#include "gpu/device/objects.h"

namespace rayengine {

/// Treelets that a ray can take along to the device at once.
inline constexpr std::uint32_t longest_list = 4;

/// Where a ray enters the second and the third treelet of its list, for the device: in half precision, rounded down.
/// The fourth goes without: where it is entered, the third has been, and a hit before that ends the ray.
std::uint32_t pack_entries(glm::vec2 entries);

/// Depths that rays have as states: before any pass, and when they are done.
inline constexpr float state_start = 0, state_done = 1;

/// One stream of rays on its way: textures with one texel a ray, and the mapped memory that they are filled from and
/// read back into. The CPU writes the spans, upload() and read_back() copy, and `finished` says when the answers are
/// there.
class StreamBatch {
 public:
  /// `side` x `side` rays, in blocks of `block` x `block`, of which `side` is a multiple. Neighbours among the rays
  /// have most in common, and devices shade blocks of texels in step.
  explicit StreamBatch(GLsizei side, GLsizei block = 4);

  /// What shaders read, by texture unit.
  const Texture& input(std::size_t unit) const { return inputs_[unit]; }
  /// Has passes write a texture, as the target after those that they have; hits are the first.
  void add_target(const Texture& texture);

  std::size_t capacity() const { return static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_); }

  /// What the shaders read: see gpu/shaders/stream/ray.glsl.
  std::span<glm::vec4> origins() const { return upload_.as<glm::vec4>(0, capacity()); }
  std::span<glm::vec4> directions() const { return upload_.as<glm::vec4>(section(), capacity()); }
  std::span<glm::uvec4> lists() const { return upload_.as<glm::uvec4>(2 * section(), capacity()); }
  std::span<glm::uvec2> entries() const { return upload_.as<glm::uvec2>(3 * section(), capacity()); }

  /// What they answer: the bits of t, and the rank of what was hit.
  struct Answer {
    float t;
    std::uint32_t rank;
  };
  std::span<const Answer> answers() const { return read_back_.as<const Answer>(0, capacity()); }

  /// The place of ray `i` in the spans: rays fill block after block.
  std::size_t place(std::size_t i) const;

  /// Fills the textures from the first `count` rays, and clears hits and states. Lists must be filled up to the end of
  /// rays_in_blocks(count).
  void upload(std::size_t count);
  /// The same without filling them, for passes that make rays: `rows` of texels.
  void start(GLsizei rows);
  std::size_t rays_in_blocks(std::size_t count) const;
  /// Binds the textures and the target, and limits drawing to the rows in use.
  void bind() const;
  void read_back();
  /// Bits of t, and ranks, as the passes leave them.
  const Texture& hits() const { return hits_; }
  /// The rows in use.
  GLsizei rows() const { return rows_; }
  /// Of the last upload and read-back.
  std::size_t bytes_carried() const { return rays_in_blocks(count_) * bytes_a_ray; }
  /// Waits for the answers. Throws Error when there is no hope of them, or they mean nothing.
  void await(Context& context) const { rayengine::await(*fence_, context); }

 private:
  static constexpr std::size_t bytes_a_ray = 3 * sizeof(glm::vec4) + sizeof(glm::uvec2) + sizeof(Answer);

  void clear();
  std::size_t section() const { return capacity() * sizeof(glm::vec4); }

  GLsizei side_, block_, rows_ = 0;
  std::size_t count_ = 0;
  MappedBuffer upload_, read_back_;
  std::array<Texture, 4> inputs_;
  Texture hits_, depth_;
  Framebuffer frame_ = make_framebuffer();
  std::vector<GLenum> targets_{GL_COLOR_ATTACHMENT0};
  std::optional<Fence> fence_;
};

}  // namespace rayengine
