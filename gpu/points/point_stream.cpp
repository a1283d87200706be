#include "gpu/points/point_stream.h"

#include <string>

#include "accel/tracer.h"

namespace rayengine {
namespace {

/// Drivers count a buffer's bytes in 31 bits.
constexpr std::size_t largest_buffer = (std::size_t{1} << 31) - 1;

GLuint create_buffer() {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  return id;
}

GLuint create_feedback() {
  GLuint id = 0;
  glCreateTransformFeedbacks(1, &id);
  return id;
}

GLuint64 result(const Query& query) {
  GLuint64 value = 0;
  glGetQueryObjectui64v(query.id(), GL_QUERY_RESULT, &value);
  return value;
}

}  // namespace

void PointCount::begin(GLuint stream) const {
  glBeginQueryIndexed(GL_PRIMITIVES_GENERATED, stream, came_.id());
  glBeginQueryIndexed(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, stream, kept_.id());
}

void PointCount::end(GLuint stream) const {
  glEndQueryIndexed(GL_TRANSFORM_FEEDBACK_PRIMITIVES_WRITTEN, stream);
  glEndQueryIndexed(GL_PRIMITIVES_GENERATED, stream);
}

void PointCount::check(std::size_t capacity) const {
  const GLuint64 came = result(came_), kept = result(kept_);
  if (came > kept)
    throw Error(std::to_string(came) + " rays came where the vertex buffer holds " + std::to_string(capacity) +
                ": give it more room");
}

PointStream::PointStream(std::size_t capacity, RayFormat format)
    : capacity_(capacity), buffer_(create_buffer()), feedback_(create_feedback()) {
  const auto bytes_each = static_cast<std::size_t>(format);
  const std::size_t bytes = capacity * bytes_each;
  if (bytes > largest_buffer)
    throw Error("the rays need a vertex buffer of " + std::to_string(bytes) + " bytes, and it can have " +
                std::to_string(largest_buffer) + ": use a smaller size, or --tracer embree");
  glNamedBufferStorage(buffer_.id(), static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
  if (glGetError() == GL_OUT_OF_MEMORY)
    throw Error("the GPU has no room for a vertex buffer of " + std::to_string(bytes) + " bytes; use --tracer embree");
  glVertexArrayVertexBuffer(vertices_.id(), 0, buffer_.id(), 0, static_cast<GLsizei>(bytes_each));
  for (GLuint i = 0; i < bytes_each / 16; ++i) {
    glEnableVertexArrayAttrib(vertices_.id(), i);
    glVertexArrayAttribBinding(vertices_.id(), i, 0);
    glVertexArrayAttribIFormat(vertices_.id(), i, 4, GL_UNSIGNED_INT, 16 * i);
  }
  glTransformFeedbackBufferBase(feedback_.id(), 0, buffer_.id());
}

void PointStream::fill(std::span<const glm::uvec4> points) const {
  glNamedBufferSubData(buffer_.id(), 0, static_cast<GLsizeiptr>(points.size_bytes()), points.data());
}

void PointStream::begin_writing() const {
  glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, feedback_.id());
  glBeginTransformFeedback(GL_POINTS);
}

void PointStream::end_writing() const {
  glEndTransformFeedback();
  glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
}

void PointStream::draw(GLsizei count) const {
  glBindVertexArray(vertices_.id());
  glDrawArrays(GL_POINTS, 0, count);
}

void PointStream::draw_written(GLuint stream) const {
  glBindVertexArray(vertices_.id());
  glDrawTransformFeedbackStream(GL_POINTS, feedback_.id(), stream);
}

}  // namespace rayengine
