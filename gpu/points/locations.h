#pragma once

#include <epoxy/gl.h>

// Uniforms that shaders of several programs have.
namespace rayengine {

inline constexpr GLint steps_location = 8, sees_background_location = 25;

}  // namespace rayengine
