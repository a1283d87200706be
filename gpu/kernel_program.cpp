#include "gpu/kernel_program.h"

#include <cstdio>

namespace rayengine {
namespace {

std::string form_define(QuadricType type) {
  const QuadricMatrix m = unit_matrix(type);
  char text[120];
  std::snprintf(text, sizeof text, "FORM=%.1f, %.1f, %.1f, %.1f, %.1f", m[0], m[4], m[7], m[8], m[9]);
  return text;
}

std::vector<std::string> quadric_defines(QuadricType type) {
  switch (type) {
    case QuadricType::general: return {"GENERAL"};
    case QuadricType::plane: return {"PLANE", form_define(type)};
    case QuadricType::disk: return {"DISK", form_define(type)};
    case QuadricType::saddle: return {"SADDLE", form_define(type)};
    case QuadricType::sphere: return {form_define(type)};
    case QuadricType::cone: return {"CAPS", "CONE", form_define(type)};
    default: return {"CAPS", form_define(type)};
  }
}

}  // namespace

Program make_kernel_program(KernelType type, const std::vector<std::string_view>& ray_sources,
                            std::vector<std::string> defines) {
  const bool triangle = type == TreeletPrimitive::triangle;
  Stage stage{0, {"accel/kernels/prelude.glsl"}, std::move(defines)};
  stage.sources.push_back(triangle ? "accel/kernels/triangle.glsl" : "accel/kernels/quadric.glsl");
  stage.sources.insert(stage.sources.end(), ray_sources.begin(), ray_sources.end());
  if (triangle) stage.sources.push_back("gpu/shaders/stream/triangle.glsl");
  stage.sources.push_back(triangle ? "gpu/shaders/stream/triangle.frag.glsl" : "gpu/shaders/stream/quadric.frag.glsl");
  if (triangle) return make_screen_program("triangle", std::move(stage));
  const auto quadric = static_cast<QuadricType>(type);
  for (std::string& define : quadric_defines(quadric)) stage.defines.push_back(std::move(define));
  return make_screen_program(to_string(quadric), std::move(stage));
}

}  // namespace rayengine
