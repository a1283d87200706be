#include "gpu/points/points_caster.h"

#include "accel/tracer.h"
#include "gpu/device/await.h"
#include "gpu/device/gl_thread.h"
#include "gpu/points/cast_method.h"

namespace rayengine {

/// Made, used and destroyed on the thread of its context.
class PointsCaster::Device {
 public:
  Device(std::shared_ptr<const Geometry> geometry, std::span<const CastLight> lights,
         std::span<const CastMaterial> materials, const glm::vec3& background, const PointsOptions& options)
      : scene_(std::move(geometry), lights, materials, background, options) {}

  const GpuInfo& gpu() { return scene_.context().info(); }

  void draw(const CastView& view) {
    if (color_.width != view.width || color_.height != view.height) resize(view);
    scene_.bind();
    glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
    glViewport(0, 0, view.width, view.height);
    method_->draw(view, frame_.id());
    await(Fence(), scene_.context());
    method_->check();
  }

  void draw_part(const CastView& view, Part part) {
    if (!method_) throw Error("no picture has been cast whose parts could be timed: cast it first");
    scene_.bind();
    method_->draw_part(view, part);
    await(Fence(), scene_.context());
  }

  std::vector<glm::vec3> read() const {
    std::vector<glm::vec3> colors(static_cast<std::size_t>(color_.width) * static_cast<std::size_t>(color_.height));
    glGetTextureImage(color_.object.id(), 0, GL_RGB, GL_FLOAT, static_cast<GLsizei>(colors.size() * sizeof colors[0]),
                      colors.data());
    return colors;
  }

 private:
  void resize(const CastView& view) {
    if (view.width < 1 || view.height < 1)
      throw Error("the picture has no pixels: its view needs a width and a height");
    method_.reset();
    color_ = {};
    method_ = make_method(view);
    color_ = make_texture(GL_RGBA32F, view.width, view.height);
    glNamedFramebufferTexture(frame_.id(), GL_COLOR_ATTACHMENT0, color_.object.id(), 0);
  }

  std::unique_ptr<CastMethod> make_method(const CastView& view) {
    switch (scene_.options().method) {
      case PointsOptions::Method::points: return make_points_method(scene_, view);
      case PointsOptions::Method::points_without_gs: return make_vertex_method(scene_, view);
      case PointsOptions::Method::fragment: break;
    }
    return make_fragment_method(scene_);
  }

  CastScene scene_;
  std::unique_ptr<CastMethod> method_;
  Texture color_;
  Framebuffer frame_ = make_framebuffer();
};

PointsCaster::PointsCaster(std::shared_ptr<const Geometry> geometry, std::span<const CastLight> lights,
                           std::span<const CastMaterial> materials, const glm::vec3& background,
                           const PointsOptions& options)
    : thread_(std::make_unique<GlThread>()) {
  thread_->run([&] { device_ = std::make_unique<Device>(geometry, lights, materials, background, options); });
}

PointsCaster::~PointsCaster() {
  thread_->run([this] { device_.reset(); });
}

std::vector<glm::vec3> PointsCaster::cast(const CastView& view) {
  return thread_->run([&] {
    device_->draw(view);
    return device_->read();
  });
}

namespace {

template <class Work>
CastSeconds timed(const Work& work) {
  CastWatch watch;
  watch.start();
  work();
  watch.stop();
  return watch.seconds();
}

}  // namespace

const GpuInfo& PointsCaster::gpu() const { return device_->gpu(); }

CastSeconds PointsCaster::time(const CastView& view) {
  return thread_->run([&] { return timed([&] { device_->draw(view); }); });
}

CastSeconds PointsCaster::time(const CastView& view, Part part) {
  return thread_->run([&] { return timed([&] { device_->draw_part(view, part); }); });
}

}  // namespace rayengine
