#include "gpu/cones/glass_caster.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "accel/tracer.h"
#include "gpu/cones/glass_paths.h"
#include "gpu/device/await.h"
#include "gpu/device/gl_thread.h"
#include "gpu/device/probe.h"

namespace rayengine {
namespace {

enum : GLuint { indices_unit = 12, environment_unit = 13, normals_unit = 14 };
/// Of the eye's pass, then of the one that scatters.
enum : GLint { eye_location = 1, corner_location, right_location, down_location, picture_location };
constexpr GLint last_rank_location = 5;

std::shared_ptr<const Geometry> checked(std::shared_ptr<const Geometry> geometry) {
  std::size_t quadrics = geometry->quadrics.size();
  for (const auto& group : geometry->groups) quadrics += group->quadrics.size();
  if (quadrics > 0)
    throw Error("the scene has " + std::to_string(quadrics) +
                " quadrics, and glass on the GPU takes 0: use --tracer cones");
  return geometry;
}

const GlassOptions& checked(const GlassOptions& options) {
  if (options.tile < 1 || options.path_length < 0 || options.stride < 1)
    throw Error("glass cannot be cast in tiles of " + std::to_string(options.tile) + ", paths of " +
                std::to_string(options.path_length) + " rays and one pass in " + std::to_string(options.stride) +
                ": give at least 1, 0 and 1");
  return options;
}

PrimitiveRef primitive(const Geometry& geometry, std::uint32_t rank) {
  const Ids ids = ids_of_rank(geometry, rank);
  return resolve(geometry, ids.object, ids.primitive);
}

/// By rank.
BufferTexture upload_indices(const Geometry& geometry, std::span<const float> indices) {
  std::vector<float> texels;
  for (std::uint32_t rank = 0; rank < geometry.primitive_count; ++rank) {
    const PrimitiveRef ref = primitive(geometry, rank);
    const std::uint32_t material = ref.geometry->objects[ref.object].material;
    if (material >= indices.size())
      throw Error("a primitive has material " + std::to_string(material) + ", and there are " +
                  std::to_string(indices.size()));
    texels.push_back(indices[material]);
  }
  return make_buffer_texture(GL_R32F, texels);
}

/// By falling rank, as the triangles lie; zeros where a mesh has none.
BufferTexture upload_normals(const Geometry& geometry) {
  std::vector<glm::vec4> texels;
  for (std::uint32_t rank = geometry.primitive_count; rank-- > 0;) {
    const PrimitiveRef ref = primitive(geometry, rank);
    for (int corner = 0; corner < 3; ++corner) {
      const auto& normals = ref.geometry->normals;
      const glm::vec3 own = normals.empty() ? glm::vec3(0) : normals[ref.geometry->triangles[ref.triangle()][corner]];
      const glm::dvec3 n = ref.instance ? ref.instance->to_group.normal_to_world(own) : glm::dvec3(own);
      texels.emplace_back(own == glm::vec3(0) ? own : glm::vec3(glm::normalize(n)), 0);
    }
  }
  return make_buffer_texture(GL_RGBA32F, texels);
}

Texture upload(const CastEnvironment& e) {
  const auto texels = static_cast<std::size_t>(e.width) * static_cast<std::size_t>(e.height);
  if (e.width < 1 || e.height < 1 || e.colors.size() != texels)
    throw Error("the environment has " + std::to_string(e.colors.size()) + " colours for " + std::to_string(e.width) +
                "x" + std::to_string(e.height) + " pixels: give one for each");
  Texture texture = make_texture(GL_RGBA32F, e.width, e.height);
  glTextureSubImage2D(texture.object.id(), 0, 0, 0, e.width, e.height, GL_RGB, GL_FLOAT, e.colors.data());
  return texture;
}

Program make_pass(std::string_view name, std::vector<std::string_view> sources) {
  sources.insert(sources.begin(), "accel/kernels/prelude.glsl");
  return make_screen_program(name, {0, std::move(sources), {}});
}

void set(GLint location, const glm::vec3& v) { glUniform3f(location, v.x, v.y, v.z); }

}  // namespace

/// Made, used and destroyed on the thread of its context.
class GlassCaster::Device {
 public:
  Device(const std::shared_ptr<const Geometry>& geometry, std::span<const float> indices,
         const CastEnvironment& environment, const GlassOptions& options)
      : options_(checked(options)),
        context_(options.device),
        scene_(checked(geometry), context_.info()),
        indices_(upload_indices(*geometry, indices)),
        normals_(upload_normals(*geometry)),
        environment_(upload(environment)) {
    require_usable(context_);
    context_.check_errors("the upload of the scene");
  }

  CastSeconds draw(const CastView& view) {
    CastWatch watch;
    prepare(view);
    watch.start();
    follow(view, options_.path_length, watch);
    see();
    await(Fence(), context_);
    watch.stop();
    return watch.seconds();
  }

  std::vector<glm::vec3> read() const {
    const glm::ivec2 picture = paths_->picture();
    std::vector<glm::vec3> colors(static_cast<std::size_t>(picture.x) * static_cast<std::size_t>(picture.y));
    glGetTextureSubImage(color_.object.id(), 0, 0, 0, 0, picture.x, picture.y, 1, GL_RGB, GL_FLOAT,
                         static_cast<GLsizei>(colors.size() * sizeof colors[0]), colors.data());
    return colors;
  }

  const GpuInfo& gpu() const { return context_.info(); }

  std::vector<float> openings(const CastView& view, int generation) {
    CastWatch watch;
    prepare(view);
    follow(view, generation - 1, watch);
    paths_->bind_rays();
    paths_->cones().build(paths_->extent());
    const Texture& apexes = paths_->cones().apexes();
    std::vector<float> angles(static_cast<std::size_t>(apexes.width) * static_cast<std::size_t>(apexes.height));
    glGetTextureImage(apexes.object.id(), 0, GL_ALPHA, GL_FLOAT, static_cast<GLsizei>(angles.size() * sizeof(float)),
                      angles.data());
    context_.check_errors("the building of cones");
    for (float& a : angles) a = a > 1 ? -1 : a < 0 ? std::numbers::pi_v<float> : std::acos(a);
    return angles;
  }

 private:
  void prepare(const CastView& view) {
    const glm::ivec2 picture(view.width, view.height);
    if (paths_ && paths_->picture() == picture) return;
    const int most = context_.info().texture_size / 2;
    if (picture.x > most || picture.y > most)
      throw Error("the picture has " + std::to_string(picture.x) + "x" + std::to_string(picture.y) +
                  " pixels, and the GPU's textures hold " + std::to_string(most) + " each way: use --tracer cones");
    paths_.reset();
    paths_.emplace(scene_, picture, options_);
    color_ = make_texture(GL_RGBA32F, paths_->extent().x, paths_->extent().y);
    glNamedFramebufferTexture(frame_.id(), GL_COLOR_ATTACHMENT0, color_.object.id(), 0);
  }

  void set_out(const CastView& view) {
    const LocalFrame& frame = scene_.list.frame;
    glBindVertexArray(vertices_.id());
    paths_->draw_to_current();
    eye_.use();
    set(eye_location, glm::vec3((view.eye - frame.center) * frame.scale));
    set(corner_location, glm::vec3(view.corner));
    set(right_location, glm::vec3(view.right));
    set(down_location, glm::vec3(view.down));
    glUniform2i(picture_location, view.width, view.height);
    draw_everywhere();
  }

  void follow(const CastView& view, int generations, CastWatch& watch) {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    set_out(view);
    for (int generation = 0; generation < generations; ++generation) {
      paths_->intersect(generation, watch);
      scatter();
    }
  }

  void scatter() {
    glBindVertexArray(vertices_.id());
    paths_->bind_rays();
    paths_->draw_to_next();
    scene_.textures.bind();
    indices_.bind(indices_unit);
    normals_.bind(normals_unit);
    scatter_.use();
    glUniform1i(last_rank_location, static_cast<GLint>(scene_.list.triangles.size()) - 1);
    draw_everywhere();
    paths_->turn();
  }

  void see() {
    glBindVertexArray(vertices_.id());
    paths_->bind_rays();
    glBindFramebuffer(GL_FRAMEBUFFER, frame_.id());
    glViewport(0, 0, color_.width, color_.height);
    environment_.bind(environment_unit);
    see_.use();
    draw_everywhere();
  }

  GlassOptions options_;
  Context context_;
  ConesScene scene_;
  BufferTexture indices_, normals_;
  Texture environment_;
  Program eye_ = make_pass("eye", {"gpu/shaders/cones/eye.frag.glsl"});
  Program scatter_ = make_pass(
      "scatter", {"accel/kernels/triangle.glsl", "gpu/shaders/stream/ray.glsl", "gpu/shaders/stream/consider.glsl",
                  "gpu/shaders/stream/triangle.glsl", "gpu/shaders/cones/scatter.frag.glsl"});
  Program see_ = make_pass("environment", {"gpu/shaders/cones/environment.frag.glsl"});
  std::optional<GlassPaths> paths_;
  Texture color_;
  Framebuffer frame_ = make_framebuffer();
  VertexArray vertices_ = make_vertex_array();
};

GlassCaster::GlassCaster(std::shared_ptr<const Geometry> geometry, std::span<const float> indices,
                         const CastEnvironment& environment, const GlassOptions& options)
    : thread_(std::make_unique<GlThread>()) {
  thread_->run([&] { device_ = std::make_unique<Device>(geometry, indices, environment, options); });
}

GlassCaster::~GlassCaster() {
  thread_->run([this] { device_.reset(); });
}

std::vector<glm::vec3> GlassCaster::cast(const CastView& view) {
  return thread_->run([&] {
    device_->draw(view);
    return device_->read();
  });
}

CastSeconds GlassCaster::time(const CastView& view) {
  return thread_->run([&] { return device_->draw(view); });
}

const GpuInfo& GlassCaster::gpu() const { return device_->gpu(); }

std::vector<float> GlassCaster::openings(const CastView& view, int generation) {
  return thread_->run([&] { return device_->openings(view, generation); });
}

}  // namespace rayengine
