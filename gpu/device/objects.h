#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace rayengine {

/// Owns one OpenGL object. Objects die on the thread of their context, before the context does.
template <void (*destroy)(GLuint)>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(GLuint id) : id_(id) {}
  GlObject(GlObject&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~GlObject() {
    if (id_) destroy(id_);
  }
  GLuint id() const { return id_; }

 private:
  GLuint id_ = 0;
};

inline void destroy_buffer(GLuint id) { glDeleteBuffers(1, &id); }
inline void destroy_texture(GLuint id) { glDeleteTextures(1, &id); }
inline void destroy_framebuffer(GLuint id) { glDeleteFramebuffers(1, &id); }
inline void destroy_vertex_array(GLuint id) { glDeleteVertexArrays(1, &id); }
inline void destroy_query(GLuint id) { glDeleteQueries(1, &id); }
inline void destroy_program(GLuint id) { glDeleteProgram(id); }
inline void destroy_shader(GLuint id) { glDeleteShader(id); }

using Framebuffer = GlObject<destroy_framebuffer>;
using VertexArray = GlObject<destroy_vertex_array>;
using Query = GlObject<destroy_query>;
using ProgramObject = GlObject<destroy_program>;
using ShaderObject = GlObject<destroy_shader>;
using TextureObject = GlObject<destroy_texture>;
using BufferObject = GlObject<destroy_buffer>;

Framebuffer make_framebuffer();
VertexArray make_vertex_array();
Query make_query(GLenum target);

/// Device memory that is written once.
struct Buffer {
  BufferObject object;
  std::size_t bytes = 0;
};
Buffer make_buffer(std::span<const std::byte> content);

/// Memory that both sides see: written or read through `bytes` by the CPU, while fences say when.
struct MappedBuffer {
  BufferObject object;
  std::span<std::byte> bytes;

  template <class T>
  std::span<T> as(std::size_t offset, std::size_t count) const {
    return {reinterpret_cast<T*>(bytes.data() + offset), count};
  }
};
enum class Mapping { upload, read_back };
MappedBuffer make_mapped_buffer(std::size_t bytes, Mapping mapping);

/// A two-dimensional texture of one level, without filtering.
struct Texture {
  TextureObject object;
  GLsizei width = 0, height = 0;

  void bind(GLuint unit) const { glBindTextureUnit(unit, object.id()); }
};
Texture make_texture(GLenum internal_format, GLsizei width, GLsizei height);

/// A buffer read by texel; one without content reads as zeros of one texel.
struct BufferTexture {
  Buffer buffer;
  TextureObject object;

  void bind(GLuint unit) const { glBindTextureUnit(unit, object.id()); }
};
BufferTexture make_buffer_texture(GLenum internal_format, std::span<const std::byte> content);
template <class T>
BufferTexture make_buffer_texture(GLenum internal_format, const std::vector<T>& content) {
  return make_buffer_texture(internal_format, std::as_bytes(std::span(content)));
}

/// A point in the command stream that the CPU can ask after.
class Fence {
 public:
  Fence() : sync_(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)) {}
  Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
  Fence& operator=(Fence&& other) noexcept {
    std::swap(sync_, other.sync_);
    return *this;
  }
  ~Fence() { glDeleteSync(sync_); }

  /// Waits up to `nanoseconds` and says whether the point was reached. Throws Error when the wait fails (a lost
  /// device).
  bool reached(std::uint64_t nanoseconds) const;

 private:
  GLsync sync_;
};

}  // namespace rayengine
