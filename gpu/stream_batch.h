#pragma once

#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <optional>
#include <span>

#include "gpu/await.h"
#include "gpu/objects.h"

namespace rayengine {

/// Treelets that a ray takes along to the device at once.
inline constexpr std::uint32_t list_length = 4;

/// One stream of rays on its way: textures with one texel a ray, and the mapped memory that they are filled from and
/// read back into. The CPU writes the spans, upload() and read_back() copy, and `finished` says when the answers are
/// there.
class StreamBatch {
 public:
  explicit StreamBatch(GLsizei side);

  std::size_t capacity() const { return static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_); }

  /// What the shaders read: see gpu/shaders/stream/ray.glsl.
  std::span<glm::vec4> origins() const { return upload_.as<glm::vec4>(0, capacity()); }
  std::span<glm::vec4> directions() const { return upload_.as<glm::vec4>(section(), capacity()); }
  std::span<glm::uvec4> lists() const { return upload_.as<glm::uvec4>(2 * section(), capacity()); }
  std::span<glm::uvec4> entries() const { return upload_.as<glm::uvec4>(3 * section(), capacity()); }

  /// What they answer: the bits of t, and the rank of what was hit.
  struct Answer {
    float t;
    std::uint32_t rank;
  };
  std::span<const Answer> answers() const { return read_back_.as<const Answer>(0, capacity()); }

  /// Fills the textures from the first `count` rays, and clears hits and states. Lists must say `none` up to the end of
  /// rays_in_rows(count).
  void upload(std::size_t count);
  std::size_t rays_in_rows(std::size_t count) const;
  /// Binds the textures, and limits drawing to the rows in use.
  void bind() const;
  void draw_states() const { glBindFramebuffer(GL_FRAMEBUFFER, states_.id()); }
  void draw_hits() const { glBindFramebuffer(GL_FRAMEBUFFER, frame_.id()); }
  void read_back();
  /// Waits for the answers. Throws Error when there is no hope of them, or they mean nothing.
  void await(Context& context) const { rayengine::await(*fence_, context); }

 private:
  std::size_t section() const { return capacity() * sizeof(glm::vec4); }

  GLsizei side_, rows_ = 0;
  MappedBuffer upload_, read_back_;
  std::array<Texture, 4> inputs_;
  Texture hits_, depth_;
  Framebuffer frame_ = make_framebuffer(), states_ = make_framebuffer();  // hits and states, states alone
  std::optional<Fence> fence_;
};

}  // namespace rayengine
