// Every shader that drivers are given is given to the Khronos group's own compiler, too: Mesa lets through what others
// refuse. The library that loads OpenGL keeps its functions in variables, through which the sources are overheard.

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <compare>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string>

#include "gpu/device/gpu_report.h"
#include "gpu/objects/objects_tracer.h"
#include "gpu/objects/ray_caster.h"
#include "gpu/points/points_caster.h"
#include "gpu/points/points_tracer.h"
#include "gpu/stream/stream_tracer.h"
#include "tests/temporary.h"

namespace rayengine {
namespace {

struct Overheard {
  std::string source;
  GLint stage;
  auto operator<=>(const Overheard&) const = default;
};
std::set<Overheard> overheard;
decltype(glShaderSource) driver_source = nullptr;

void overhear(GLuint shader, GLsizei count, const GLchar* const* text, const GLint* lengths) {
  if (shader) {
    GLint stage = 0;
    glGetShaderiv(shader, GL_SHADER_TYPE, &stage);
    overheard.insert({text[0], stage});
  }
  driver_source(shader, count, text, lengths);
}

/// From a cache of its own, so that everything is compiled.
class Overhearing {
 public:
  Overhearing() {
    setenv("XDG_CACHE_HOME", cache_.path().c_str(), 1);
    const Context context;
    glShaderSource(0, 0, nullptr, nullptr);  // an error without effect, after which the variable holds the driver's
    driver_source = std::exchange(glShaderSource, &overhear);
  }
  ~Overhearing() {
    glShaderSource = driver_source;
    unsetenv("XDG_CACHE_HOME");
  }

 private:
  test::TemporaryFolder cache_;
};

std::shared_ptr<const Geometry> one_of_each_type() {
  GeometryBuilder builder;
  for (std::size_t i = 0; i < quadric_type_count; ++i) {
    const auto type = static_cast<QuadricType>(i);
    const bool general = type == QuadricType::general;
    builder.add(
        QuadricShape{type, false, {}, general ? std::optional(unit_matrix(QuadricType::sphere)) : std::nullopt, {}});
  }
  builder.add(Mesh{{{5, 3, 0}, {8, 3, 0}, {5, 5, 1}}, {}, {{0, 1, 2}}});
  return builder.build();
}

void cast_points() {
  GeometryBuilder builder;
  builder.add(Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}});
  const auto triangle = builder.build();
  using Method = PointsOptions::Method;
  const std::vector<CastLight> lights(1);
  const std::vector<CastMaterial> materials(1);
  for (const Method method : {Method::points, Method::points_without_gs, Method::fragment})
    for (const bool fat : {false, true})
      PointsCaster(triangle, lights, materials, glm::vec3(0), {.method = method, .fat = fat, .reflections = 1})
          .cast({{0, 0, 4}, {0, 0, -1}, {.1, 0, 0}, {0, .1, 0}, 4, 4});
}

void compile_everything() {
  const auto geometry = one_of_each_type();
  report_on_gpu();
  const std::vector<Ray> ray(1);
  std::vector<std::uint32_t> status(1);
  make_stream_tracer(geometry, Precision::fast)->any(ray, status, RayClass::shadow);
  make_objects_tracer(geometry, Precision::fast);
  const std::vector<CastMaterial> materials(1);
  RayCaster(geometry, {}, materials);
  make_points_tracer(geometry, Precision::fast);
  cast_points();
}

const char* extension(GLint stage) {
  switch (stage) {
    case GL_VERTEX_SHADER: return ".vert";
    case GL_GEOMETRY_SHADER: return ".geom";
    case GL_COMPUTE_SHADER: return ".comp";
    default: return ".frag";
  }
}

TEST(Portability, EveryShaderIsGlslAsTheStandardHasIt) {
  if (std::system("glslangValidator --version > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "no glslangValidator: install glslang-tools";
  {
    const Overhearing all;
    compile_everything();
  }
  EXPECT_GE(overheard.size(), 3 * (quadric_type_count + 1));
  const test::TemporaryFolder folder;
  int count = 0;
  for (const auto& [source, stage] : overheard) folder.write(std::to_string(count++) + extension(stage), source);
  const std::string command = "cd '" + folder.path().string() + "' && glslangValidator *.* > log 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << std::ifstream(folder.path() / "log").rdbuf();
}

}  // namespace
}  // namespace rayengine
