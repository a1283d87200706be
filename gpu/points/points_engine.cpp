#include "gpu/points/points_engine.h"

#include <tbb/parallel_for.h>

#include <glm/vec4.hpp>

#include "gpu/batches.h"
#include "gpu/device/await.h"
#include "gpu/device/probe.h"
#include "gpu/points/find_sources.h"
#include "gpu/points/locations.h"

namespace rayengine {
namespace {

enum : GLint { first_list_location = 18, any_hit_location };

/// As gpu/shaders/points/tracer.vert.glsl reads it.
struct Point {
  glm::vec3 origin;
  float tmin;
  glm::vec3 direction;
  float tmax;
  std::uint32_t floor_rank, unused[3];
};
static_assert(sizeof(Point) == 48);

struct Answer {
  float t;
  std::uint32_t rank;
};

constexpr GLint no_end = 1 << 30;

std::size_t batch_size(const PointsTracerOptions& options, const GpuInfo& gpu) {
  if (options.batch) return options.batch;
  return std::size_t{1} << (gpu.software ? 15 : 20);
}

Program make_program(const std::vector<KernelType>& types) {
  const Sources sources = grid_walk_sources + Sources{"gpu/shaders/points/tracer.vert.glsl"};
  return Program("points", {{GL_VERTEX_SHADER, sources, {grid_tests(types)}}});
}

void describe_points(GLuint vertices, GLuint buffer) {
  glVertexArrayVertexBuffer(vertices, 0, buffer, 0, sizeof(Point));
  for (GLuint i = 0; i < 3; ++i) {
    glEnableVertexArrayAttrib(vertices, i);
    glVertexArrayAttribBinding(vertices, i, 0);
    glVertexArrayAttribIFormat(vertices, i, 4, GL_UNSIGNED_INT, 16 * i);
  }
}

}  // namespace

PointsEngine::PointsEngine(std::shared_ptr<const Geometry> geometry, const PointsTracerOptions& options)
    : context_(options.device), batch_(batch_size(options, context_.info())) {
  const FlatScene flat = flatten(std::move(geometry));
  scene_.emplace(flat, build_grid(*flat.geometry), context_.info());
  require_usable(context_);
  program_.emplace(make_program(scene_->textures.types()));
  points_ = make_mapped_buffer(batch_ * sizeof(Point), Mapping::upload);
  answers_ = make_mapped_buffer(batch_ * sizeof(Answer), Mapping::read_back);
  describe_points(vertices_.id(), points_.object.id());
  // Nothing is drawn, and yet OpenGL wants something to draw to.
  glNamedFramebufferParameteri(nowhere_.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, 1);
  glNamedFramebufferParameteri(nowhere_.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, 1);
  context_.check_errors("the upload of the scene");
}

void PointsEngine::answer(std::span<Traveller> travellers, StreamQuery query) {
  const auto points = points_.as<Point>(0, travellers.size());
  tbb::parallel_for(std::size_t{0}, travellers.size(), [&](std::size_t i) {
    const FrameRay& f = travellers[i].frame;
    points[i] = {f.origin, f.tmin, f.direction, f.tmax, travellers[i].floor_rank, {}};
  });
  program_->use();
  scene_->textures.bind();
  scene_->textures.set_uniforms();
  glUniform1i(steps_location, no_end);
  glUniform1ui(first_list_location, scene_->first_list);
  glUniform1i(any_hit_location, query == StreamQuery::any);
  glBindFramebuffer(GL_FRAMEBUFFER, nowhere_.id());
  glBindVertexArray(vertices_.id());
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, answers_.object.id());
  glEnable(GL_RASTERIZER_DISCARD);
  glBeginTransformFeedback(GL_POINTS);
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(travellers.size()));
  glEndTransformFeedback();
  glDisable(GL_RASTERIZER_DISCARD);
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  await(Fence(), context_);
  const auto answers = answers_.as<const Answer>(0, travellers.size());
  for (std::size_t i = 0; i < travellers.size(); ++i)
    travellers[i].best_t = answers[i].t, travellers[i].best_rank = answers[i].rank;
}

void PointsEngine::trace(std::span<const Ray> rays, StreamQuery query, const Arrive& arrive) {
  trace_in_batches(
      rays, batch_, [this](const Ray& ray) { return in_frame(scene_->frame, ray); },
      [&](std::span<Traveller> travellers) { answer(travellers, query); }, arrive);
}

}  // namespace rayengine
