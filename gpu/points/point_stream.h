#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <glm/vec4.hpp>
#include <span>

#include "gpu/device/objects.h"

namespace rayengine {

inline void destroy_feedback(GLuint id) { glDeleteTransformFeedbacks(1, &id); }
using TransformFeedback = GlObject<destroy_feedback>;

/// How gpu/shaders/points lay out a ray, by its bytes.
enum class RayFormat : std::size_t {
  fat = 64,     ///< as the paper has it
  packed = 32,  ///< only what a ray needs that waits to be intersected
  hit = 48,     ///< also what it hit
};

/// Counts the points that a draw brought and those that there was room for, without waiting for them.
class PointCount {
 public:
  void begin(GLuint stream) const;
  void end(GLuint stream) const;
  /// Waits for the draw, and throws Error when more came than the buffer's `capacity`.
  void check(std::size_t capacity) const;

 private:
  Query came_ = make_query(GL_PRIMITIVES_GENERATED), kept_ = make_query(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN);
};

/// Rays as points in a vertex buffer, which one pass writes by transform feedback and the next one
/// draws, without the processor knowing how many there are.
class PointStream {
 public:
  /// Throws Error when `capacity` points are more than a vertex buffer may hold, or than the device has room for.
  PointStream(std::size_t capacity, RayFormat format);

  void fill(std::span<const glm::uvec4> points) const;
  std::size_t capacity() const { return capacity_; }

  /// Around the draw that writes it.
  void begin_writing() const;
  void end_writing() const;
  /// Draws the first `count` points; or those that were written last, by the geometry shader's stream `stream`.
  void draw(GLsizei count) const;
  void draw_written(GLuint stream) const;

 private:
  std::size_t capacity_;
  BufferObject buffer_;
  VertexArray vertices_ = make_vertex_array();
  TransformFeedback feedback_;
};

}  // namespace rayengine
