#include "gpu/stream/stream_batch.h"

#include <algorithm>
#include <bit>
#include <glm/packing.hpp>
#include <limits>

#include "accel/ray.h"
#include "gpu/scene/kernel_program.h"

namespace rayengine {
namespace {

std::array<Texture, 4> make_inputs(GLsizei side) {
  return {make_texture(GL_RGBA32F, side, side), make_texture(GL_RGBA32F, side, side),
          make_texture(GL_RGBA32UI, side, side), make_texture(GL_RG32UI, side, side)};
}

/// Of the inputs, in the mapped memory.
constexpr std::array<GLenum, 4> layouts{GL_RGBA, GL_RGBA, GL_RGBA_INTEGER, GL_RG_INTEGER};

/// The largest number in half precision that is not above t; or, where halves lose digits, one below all, by which no
/// ray is ever done.
float half_below(float t) {
  constexpr float least = 0x1p-14f, most = 65504;
  if (!(t >= least)) return -std::numeric_limits<float>::infinity();
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(std::min(t, most)) & ~0x1FFFu);
}

}  // namespace

std::uint32_t pack_entries(glm::vec2 entries) {
  return glm::packHalf2x16({half_below(entries.x), half_below(entries.y)});
}

StreamBatch::StreamBatch(GLsizei side, GLsizei block)
    : side_(side),
      block_(block),
      upload_(make_mapped_buffer(3 * section() + capacity() * sizeof(glm::uvec2), Mapping::upload)),
      read_back_(make_mapped_buffer(capacity() * sizeof(Answer), Mapping::read_back)),
      inputs_(make_inputs(side)),
      hits_(make_texture(GL_RG32UI, side, side)),
      depth_(make_texture(GL_DEPTH_COMPONENT32F, side, side)) {
  glNamedFramebufferTexture(frame_.id(), GL_COLOR_ATTACHMENT0, hits_.object.id(), 0);
  glNamedFramebufferTexture(frame_.id(), GL_DEPTH_ATTACHMENT, depth_.object.id(), 0);
}

void StreamBatch::add_target(const Texture& texture) {
  targets_.push_back(static_cast<GLenum>(GL_COLOR_ATTACHMENT0 + targets_.size()));
  glNamedFramebufferTexture(frame_.id(), targets_.back(), texture.object.id(), 0);
  glNamedFramebufferDrawBuffers(frame_.id(), static_cast<GLsizei>(targets_.size()), targets_.data());
}

std::size_t StreamBatch::place(std::size_t i) const {
  const auto side = static_cast<std::size_t>(side_), block = static_cast<std::size_t>(block_);
  const std::size_t of_block = i / (block * block), in_block = i % (block * block);
  const std::size_t column = of_block % (side / block) * block + in_block % block;
  const std::size_t row = of_block / (side / block) * block + in_block / block;
  return row * side + column;
}

std::size_t StreamBatch::rays_in_blocks(std::size_t count) const {
  const std::size_t block_row = static_cast<std::size_t>(block_) * static_cast<std::size_t>(side_);
  return (count + block_row - 1) / block_row * block_row;
}

void StreamBatch::upload(std::size_t count) {
  count_ = count;
  rows_ = static_cast<GLsizei>(rays_in_blocks(count)) / side_;
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, upload_.object.id());
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    glTextureSubImage2D(inputs_[i].object.id(), 0, 0, 0, side_, rows_, layouts[i], i < 2 ? GL_FLOAT : GL_UNSIGNED_INT,
                        reinterpret_cast<const void*>(i * section()));
  }
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  clear();
}

void StreamBatch::start(GLsizei rows) {
  rows_ = rows;
  clear();
}

void StreamBatch::clear() {
  bind();
  const GLuint no_hit[4] = {0x7F7FFFFFu, no_id, 0, 0};  // the largest number
  glClearNamedFramebufferuiv(frame_.id(), GL_COLOR, 0, no_hit);
  glClearNamedFramebufferfv(frame_.id(), GL_DEPTH, 0, &state_start);
}

void StreamBatch::bind() const {
  for (GLuint i = 0; i < inputs_.size(); ++i) inputs_[i].bind(i);
  hits_.bind(hits_unit);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
  glViewport(0, 0, side_, rows_);
  glScissor(0, 0, side_, rows_);
}

void StreamBatch::read_back() {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_.id());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, read_back_.object.id());
  glReadPixels(0, 0, side_, rows_, GL_RG_INTEGER, GL_UNSIGNED_INT, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  fence_.emplace();
}

}  // namespace rayengine
