#include "gpu/device/objects.h"

#include <array>
#include <string>

#include "accel/tracer.h"

namespace rayengine {
namespace {

GLuint create_buffer() {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  return id;
}

GLuint create_texture(GLenum target) {
  GLuint id = 0;
  glCreateTextures(target, 1, &id);
  return id;
}

}  // namespace

Framebuffer make_framebuffer() {
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  return Framebuffer(id);
}

VertexArray make_vertex_array() {
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  return VertexArray(id);
}

Query make_query(GLenum target) {
  GLuint id = 0;
  glCreateQueries(target, 1, &id);
  return Query(id);
}

Buffer make_buffer(std::span<const std::byte> content) {
  static constexpr std::array<std::byte, 16> nothing{};  // storage of no bytes is an error
  const auto bytes = content.empty() ? std::span<const std::byte>(nothing) : content;
  Buffer buffer{BufferObject(create_buffer()), bytes.size()};
  glNamedBufferStorage(buffer.object.id(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(), 0);
  return buffer;
}

MappedBuffer make_mapped_buffer(std::size_t bytes, Mapping mapping) {
  const GLbitfield access =
      (mapping == Mapping::upload ? GL_MAP_WRITE_BIT : GL_MAP_READ_BIT) | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  MappedBuffer buffer{BufferObject(create_buffer()), {}};
  const auto size = static_cast<GLsizeiptr>(bytes);
  glNamedBufferStorage(buffer.object.id(), size, nullptr, access);
  auto* address = static_cast<std::byte*>(glMapNamedBufferRange(buffer.object.id(), 0, size, access));
  if (!address) throw Error("the GPU cannot map a buffer of " + std::to_string(bytes) + " bytes; use --tracer embree");
  buffer.bytes = {address, bytes};
  return buffer;
}

Texture make_texture(GLenum internal_format, GLsizei width, GLsizei height) {
  Texture texture{TextureObject(create_texture(GL_TEXTURE_2D)), width, height};
  const GLuint id = texture.object.id();
  glTextureStorage2D(id, 1, internal_format, width, height);
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

BufferTexture make_buffer_texture(GLenum internal_format, std::span<const std::byte> content) {
  BufferTexture texture{make_buffer(content), TextureObject(create_texture(GL_TEXTURE_BUFFER))};
  glTextureBuffer(texture.object.id(), internal_format, texture.buffer.object.id());
  return texture;
}

bool Fence::reached(std::uint64_t nanoseconds) const {
  const GLenum result = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, nanoseconds);
  if (result == GL_WAIT_FAILED) throw Error("the GPU was lost while waiting for it; use --tracer embree");
  return result != GL_TIMEOUT_EXPIRED;
}

}  // namespace rayengine
