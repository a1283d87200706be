#include "gpu/scene/kernel_program.h"

#include <cstdio>

namespace rayengine {
namespace {

QuadricType quadric_of(const KernelType& type) { return static_cast<QuadricType>(type.primitive); }

/// The coefficients A, E, H, I, J.
std::string form_of(QuadricType type) {
  const QuadricMatrix m = unit_matrix(type);
  char text[120];
  std::snprintf(text, sizeof text, "%.1f, %.1f, %.1f, %.1f, %.1f", m[0], m[4], m[7], m[8], m[9]);
  return text;
}

/// How it is clipped, whether it may have caps, and whether it is a cone.
std::string traits_of(const KernelType& kernel) {
  const std::string planes = kernel.clipped ? "by_planes, " : "never, ", caps = kernel.capped ? "true, " : "false, ";
  switch (quadric_of(kernel)) {
    case QuadricType::plane: return "never, false, false";
    case QuadricType::disk: return "to_disk, false, false";
    case QuadricType::saddle: return "to_cube, false, false";
    case QuadricType::sphere: return planes + "false, false";
    case QuadricType::cone: return planes + caps + "true";
    default: return planes + caps + "false";
  }
}

}  // namespace

std::string test_call(KernelType type, const std::string& index) {
  if (type == TreeletPrimitive::triangle) return "test_triangle(" + index + ")";
  const QuadricType quadric = quadric_of(type);
  if (quadric == QuadricType::general) return "test_general(" + index + ")";
  const std::string test = type.balls ? "test_ball(" : "test_unit(";
  return test + index + ", " + form_of(quadric) + (type.balls ? "" : ", " + traits_of(type)) + ")";
}

std::string normal_call(KernelType type, const std::string& index, const std::string& position,
                        const std::string& rank) {
  if (type == TreeletPrimitive::triangle) return "triangle_normal(" + index + ")";
  const QuadricType quadric = quadric_of(type);
  const std::string arguments = index + ", " + position + ", " + rank;
  if (quadric == QuadricType::general) return "general_normal(" + arguments + ")";
  return "unit_normal(" + arguments + ", " + form_of(quadric) + ")";
}

std::string grid_tests(const std::vector<KernelType>& types) {
  std::string text = "TEST_ALL=";
  for (std::size_t place = 0; place < types.size(); ++place) {
    const bool triangles = types[place] == TreeletPrimitive::triangle;
    text += "TEST_MEMBERS(" + std::to_string(place) + ", " +
            (triangles ? "triangle_members, 3, " : "quadric_members, 4, ") + test_call(types[place], "i") + ") ";
  }
  return text;
}

std::string grid_normals(const std::vector<KernelType>& types) {
  std::string text = "NORMAL_ALL=";
  for (std::size_t place = 0; place < types.size(); ++place)
    text += "NORMAL_OF(" + std::to_string(place) + ", " + normal_call(types[place], "i", "position", "rank") + ") ";
  return text;
}

std::string_view kernel_name(KernelType type) {
  return type == TreeletPrimitive::triangle ? "triangle" : to_string(quadric_of(type));
}

Stage kernel_stage(KernelType type, const std::vector<std::string_view>& ray_sources,
                   std::vector<std::string> defines) {
  const bool triangle = type == TreeletPrimitive::triangle;
  Stage stage{GL_FRAGMENT_SHADER, {"accel/kernels/prelude.glsl"}, std::move(defines)};
  stage.sources.push_back(triangle ? "accel/kernels/triangle.glsl" : "accel/kernels/quadric.glsl");
  stage.sources.insert(stage.sources.end(), ray_sources.begin(), ray_sources.end());
  stage.sources.push_back(triangle ? "gpu/shaders/stream/triangle.glsl" : "gpu/shaders/stream/quadric.glsl");
  stage.sources.push_back(triangle ? "gpu/shaders/stream/triangle.frag.glsl" : "gpu/shaders/stream/quadric.frag.glsl");
  if (triangle) return stage;
  stage.defines.push_back("TEST(i)=" + test_call(type, "i"));
  stage.defines.push_back("NORMAL(i, position, rank)=" + normal_call(type, "i", "position", "rank"));
  return stage;
}

Program make_kernel_program(KernelType type, const std::vector<std::string_view>& ray_sources,
                            std::vector<std::string> defines) {
  return make_screen_program(kernel_name(type), kernel_stage(type, ray_sources, std::move(defines)));
}

}  // namespace rayengine
