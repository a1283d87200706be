#include "gpu/grid/grid_caster.h"

#include <glm/gtc/type_ptr.hpp>
#include <optional>

#include "accel/tracer.h"
#include "gpu/device/gl_thread.h"
#include "gpu/device/probe.h"
#include "gpu/scene/shading_textures.h"

namespace rayengine {
namespace {

enum : GLint { reflections_location = 20, shadows_location, light_count_location, background_location, start_location };
enum : GLuint { gathered_unit = 15, weights_unit = 16 };

Program make_eye_program() {
  return make_screen_program("eye", {0,
                                     {"gpu/shaders/stream/ray.glsl", "gpu/shaders/points/ray.glsl",
                                      "gpu/shaders/points/view.glsl", "gpu/shaders/grid/eye.frag.glsl"},
                                     {}});
}

void set(const Program& program, const char* name, const glm::vec3& v) {
  glUniform3fv(program.uniform(name), 1, glm::value_ptr(v));
}

}  // namespace

/// Made, used and destroyed on the thread of its context.
class GridCaster::Device {
 public:
  Device(const std::shared_ptr<const Geometry>& geometry, std::span<const CastLight> lights,
         std::span<const CastMaterial> materials, const glm::vec3& background, const GridCastOptions& options)
      : options_(options),
        context_(options.tracer.device),
        scene_(flatten(geometry)),
        grid_(build_grid(*scene_.geometry, options.tracer.grid)),
        textures_(scene_, grid_, context_.info()),
        shading_(*geometry, grid_.lists.frame, lights, materials),
        lights_(static_cast<GLint>(lights.size())),
        background_(background),
        eye_(make_eye_program()),
        kernels_(textures_.types(), StreamQuery::closest, {},
                 {{"accel/kernels/highlight.glsl", "gpu/shaders/shade.glsl"}, [this] { set_uniforms(); }}) {
    require_usable(context_);
    context_.check_errors("the upload of the scene");
  }

  GridWork draw(const CastView& view, bool timed) {
    if (!batch_ || width_ != view.width || height_ != view.height) resize(view);
    glBindVertexArray(vertices_.id());
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    batch_->start(view.height);
    make_eye_rays(view);
    shading_.bind();
    gathered_.bind(gathered_unit);
    weights_.bind(weights_unit);
    GridWork work = kernels_.run(*batch_, textures_, options_.tracer.policy.value_or(GridPolicy{}), timed);
    await(Fence(), context_);
    return work;
  }

  std::vector<glm::vec3> read() const {
    std::vector<glm::vec3> colors(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    glGetTextureSubImage(gathered_.object.id(), 0, 0, 0, 0, width_, height_, 1, GL_RGB, GL_FLOAT,
                         static_cast<GLsizei>(colors.size() * sizeof colors[0]), colors.data());
    return colors;
  }

  const Grid& grid() const { return grid_; }
  const GpuInfo& gpu() const { return context_.info(); }

 private:
  void resize(const CastView& view) {
    const int side = (std::max(view.width, view.height) + 3) / 4 * 4;
    if (side > context_.info().texture_size)
      throw Error("a picture of " + std::to_string(view.width) + " x " + std::to_string(view.height) +
                  " needs textures " + std::to_string(side) + " wide, and the GPU has them up to " +
                  std::to_string(context_.info().texture_size) + "; use --tracer grid");
    width_ = view.width, height_ = view.height;
    gathered_ = make_texture(GL_RGBA32F, side, side);
    weights_ = make_texture(GL_RGBA32F, side, side);
    batch_.emplace(side);
    batch_->add_target(batch_->input(GridKernels::places_input));
    for (const std::size_t input : {0, 1}) batch_->add_target(batch_->input(input));
    for (const Texture* texture : {&gathered_, &weights_}) batch_->add_target(*texture);
  }

  void make_eye_rays(const CastView& view) {
    const LocalFrame& frame = grid_.lists.frame;
    eye_.use();
    set(eye_, "eye", glm::vec3((view.eye - frame.center) * frame.scale));
    set(eye_, "view_corner", glm::vec3(view.corner));
    set(eye_, "view_right", glm::vec3(view.right));
    set(eye_, "view_down", glm::vec3(view.down));
    glUniform2f(eye_.uniform("screen_size"), static_cast<float>(view.width), static_cast<float>(view.height));
    set_start();
    draw_everywhere();
    glTextureBarrier();
  }

  void set_start() const {
    const bool unbounded = grid_.lists.unbounded.size() > 0;
    glUniform2ui(start_location, unbounded ? unbounded_treelet(grid_.lists) : no_id, unbounded);
  }

  void set_uniforms() const {
    glUniform1i(reflections_location, options_.reflections);
    glUniform1i(shadows_location, options_.shadows && lights_ > 0);
    glUniform1i(light_count_location, lights_);
    glUniform3fv(background_location, 1, glm::value_ptr(background_));
    set_start();
  }

  GridCastOptions options_;
  Context context_;
  FlatScene scene_;
  Grid grid_;
  GridTextures textures_;
  ShadingTextures shading_;
  GLint lights_;
  glm::vec3 background_;
  Program eye_;
  GridKernels kernels_;
  Texture gathered_, weights_;
  std::optional<StreamBatch> batch_;
  int width_ = 0, height_ = 0;
  VertexArray vertices_ = make_vertex_array();
};

GridCaster::GridCaster(std::shared_ptr<const Geometry> geometry, std::span<const CastLight> lights,
                       std::span<const CastMaterial> materials, const glm::vec3& background,
                       const GridCastOptions& options)
    : thread_(std::make_unique<GlThread>()) {
  thread_->run([&] { device_ = std::make_unique<Device>(geometry, lights, materials, background, options); });
}

GridCaster::~GridCaster() {
  thread_->run([this] { device_.reset(); });
}

std::vector<glm::vec3> GridCaster::cast(const CastView& view) {
  return thread_->run([&] {
    device_->draw(view, false);
    return device_->read();
  });
}

GridWork GridCaster::measure(const CastView& view) {
  return thread_->run([&] { return device_->draw(view, true); });
}

CastSeconds GridCaster::time(const CastView& view) {
  return thread_->run([&] {
    CastWatch watch;
    watch.start();
    device_->draw(view, false);
    watch.stop();
    return watch.seconds();
  });
}

glm::uvec3 GridCaster::resolution() const { return device_->grid().counts; }
const GpuInfo& GridCaster::gpu() const { return device_->gpu(); }
std::size_t GridCaster::members() const { return device_->grid().members(); }

}  // namespace rayengine
