#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gpu/device/objects.h"

namespace rayengine {

/// One stage of a program: embedded sources by name, in order, after "#version 450 core" and `defines` ("A=1").
struct Stage {
  GLenum type;
  std::vector<std::string_view> sources;
  std::vector<std::string> defines;
};

/// A linked program. Throws Error with the compiler's first complaint, its source's name and line.
class Program {
 public:
  Program(std::string_view name, const std::vector<Stage>& stages);

  GLuint id() const { return object_.id(); }
  void use() const { glUseProgram(id()); }
  /// The location of a uniform; -1, which OpenGL ignores, when the compiler removed it.
  GLint uniform(const char* name) const { return glGetUniformLocation(id(), name); }
  /// Whether the program came from the cache of the user's earlier runs.
  bool cached() const { return cached_; }

 private:
  ProgramObject object_;
  bool cached_ = false;
};

/// A program that draws over every texel of the viewport: `fragment` under the shared vertex stage. Draw with
/// draw_everywhere().
Program make_screen_program(std::string_view name, Stage fragment);

/// One triangle that covers the viewport, at depth `depth` in [0, 1]. A vertex array must be bound, glClipControl must
/// be GL_ZERO_TO_ONE, and the program from make_screen_program() in use.
void draw_everywhere(float depth = 0);

}  // namespace rayengine
