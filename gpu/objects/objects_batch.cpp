#include "gpu/objects/objects_batch.h"

#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <glm/vec4.hpp>

#include "gpu/scene/kernel_program.h"

namespace rayengine {
namespace {

/// By texture unit: origins, directions, (treelet lists, which no one reads), entries; or all packed into one.
std::vector<Texture> make_inputs(GLsizei side, bool half) {
  std::vector<Texture> inputs;
  for (const GLenum format : {GL_RGBA32F, GL_RGBA32F, GL_RGBA32UI})
    if (!half || inputs.empty()) inputs.push_back(make_texture(half ? GL_RGBA32UI : format, side, side));
  return inputs;
}

/// Figure 5: a component of a position in the low half, one of a normal in the high.
glm::uvec3 packed(const glm::vec3& low, const glm::vec3& high) {
  return {glm::packHalf2x16({low.x, high.x}), glm::packHalf2x16({low.y, high.y}), glm::packHalf2x16({low.z, high.z})};
}

}  // namespace

ObjectsBatch::ObjectsBatch(GLsizei side, bool half)
    : side_(side),
      half_(half),
      inputs_(make_inputs(side, half)),
      upload_(make_mapped_buffer(inputs_.size() * capacity() * sizeof(glm::vec4), Mapping::upload)),
      read_back_(make_mapped_buffer(capacity() * sizeof(glm::uvec4), Mapping::read_back)) {
  for (std::size_t i = 0; i < 2; ++i) {
    hits_[i] = make_texture(half ? GL_RGBA32UI : GL_RG32UI, side, side);
    glNamedFramebufferTexture(frames_[i].id(), GL_COLOR_ATTACHMENT0, hits_[i].object.id(), 0);
  }
}

void ObjectsBatch::write(const Traveller& t, std::size_t i) {
  const FrameRay& f = t.frame;
  const auto section = [&](std::size_t input) { return upload_.as<glm::vec4>(input * capacity() * 16, capacity()); };
  if (half_) {
    upload_.as<glm::uvec4>(0, capacity())[i] = {packed(f.origin, f.direction), glm::packHalf2x16({f.tmin, f.tmax})};
    return;
  }
  section(0)[i] = {f.origin, f.tmin};
  section(1)[i] = {f.direction, f.tmax};
  upload_.as<glm::uvec4>(2 * capacity() * 16, capacity())[i] = {t.floor_rank, 0, 0, 0};
}

void ObjectsBatch::upload(std::span<const Traveller> travellers) {
  rows_ =
      static_cast<GLsizei>((travellers.size() + static_cast<std::size_t>(side_) - 1) / static_cast<std::size_t>(side_));
  for (std::size_t i = 0; i < travellers.size(); ++i) write(travellers[i], i);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, upload_.object.id());
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const bool integer = half_ || i == 2;
    glTextureSubImage2D(inputs_[i].object.id(), 0, 0, 0, side_, rows_, integer ? GL_RGBA_INTEGER : GL_RGBA,
                        integer ? GL_UNSIGNED_INT : GL_FLOAT, reinterpret_cast<const void*>(i * capacity() * 16));
    inputs_[i].bind(i == 2 ? entries_unit : static_cast<GLuint>(i));
  }
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  glViewport(0, 0, side_, rows_);
  const GLuint no_hit[4] = {0x7F7FFFFFu, no_id, 0, no_id};  // t and rank; in halves only the last counts
  glClearNamedFramebufferuiv(frames_[output_].id(), GL_COLOR, 0, no_hit);
}

void ObjectsBatch::turn() {
  hits_[output_].bind(hits_unit);
  output_ = 1 - output_;
  glBindFramebuffer(GL_FRAMEBUFFER, frames_[output_].id());
}

void ObjectsBatch::read(Traveller& t, std::size_t i) const {
  if (!half_) {
    struct Answer {
      float t;
      std::uint32_t rank;
    };
    const Answer& answer = read_back_.as<const Answer>(0, capacity())[i];
    t.best_t = answer.t, t.best_rank = answer.rank;
    return;
  }
  const glm::uvec4& answer = read_back_.as<const glm::uvec4>(0, capacity())[i];
  const glm::vec2 x = glm::unpackHalf2x16(answer.x), y = glm::unpackHalf2x16(answer.y),
                  z = glm::unpackHalf2x16(answer.z);
  const glm::vec3 d = t.frame.direction;
  t.best_rank = answer.w;
  t.best_t = glm::dot(glm::vec3(x.x, y.x, z.x) - t.frame.origin, d) / glm::dot(d, d);
  t.normal = glm::vec3(x.y, y.y, z.y);
}

void ObjectsBatch::read_back(std::span<Traveller> travellers, Context& context) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frames_[1 - output_].id());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, read_back_.object.id());
  glReadPixels(0, 0, side_, rows_, half_ ? GL_RGBA_INTEGER : GL_RG_INTEGER, GL_UNSIGNED_INT, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  await(Fence(), context);
  for (std::size_t i = 0; i < travellers.size(); ++i) read(travellers[i], i);
}

}  // namespace rayengine
