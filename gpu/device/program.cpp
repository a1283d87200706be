#include "gpu/device/program.h"

#include <algorithm>
#include <regex>

#include "accel/tracer.h"
#include "gpu/device/program_cache.h"
#include "gpu/device/shaders.h"

namespace rayengine {
namespace {

std::string_view embedded(std::string_view name) {
  const auto all = embedded_shaders();
  const auto found = std::find_if(all.begin(), all.end(), [=](const EmbeddedText& t) { return t.name == name; });
  if (found == all.end()) throw Error("there is no shader source " + std::string(name) + " in this build");
  return found->text;
}

/// Lines of source i are numbered from (i + 1) * this, so that a message tells which source it means: Mesa keeps no
/// more than the line of a #line directive.
constexpr std::size_t lines_per_source = 10000;

std::string assemble(const Stage& stage) {
  std::string text = "#version 450 core\n";
  for (std::string define : stage.defines) {
    if (const std::size_t equals = define.find('='); equals != std::string::npos) define[equals] = ' ';
    text += "#define " + define + "\n";
  }
  for (std::size_t i = 0; i < stage.sources.size(); ++i) {
    text += "#line " + std::to_string((i + 1) * lines_per_source + 1) + "\n";
    text += embedded(stage.sources[i]);
  }
  return text;
}

/// "0:10023(5): error: ..." (Mesa) and "0(10023) : error ..." (NVIDIA) become "gpu/shaders/x.glsl:23: ...".
std::string readable(const std::string& log, const Stage& stage) {
  static const std::regex place(R"(\d+[:(](\d+)\)?(?:\(\d+\))?\s*:\s*(.*))");
  std::smatch match;
  const bool placed = std::regex_search(log, match, place);
  const std::size_t line = placed ? std::stoul(match[1]) : 0, source = line / lines_per_source;
  if (source < 1 || source > stage.sources.size()) return log.substr(0, log.find('\n'));
  return std::string(stage.sources[source - 1]) + ":" + std::to_string(line % lines_per_source) + ": " + match[2].str();
}

ShaderObject compile(std::string_view name, const Stage& stage, const std::string& text) {
  ShaderObject shader(glCreateShader(stage.type));
  const char* start = text.c_str();
  glShaderSource(shader.id(), 1, &start, nullptr);
  glCompileShader(shader.id());
  GLint done = 0;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &done);
  if (done) return shader;
  std::string log(16384, '\0');
  GLsizei length = 0;
  glGetShaderInfoLog(shader.id(), static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  throw Error("the GPU does not compile the program " + std::string(name) + ": " + readable(log, stage));
}

void link(std::string_view name, const ProgramObject& program) {
  glProgramParameteri(program.id(), GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
  glLinkProgram(program.id());
  GLint done = 0;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &done);
  if (done) return;
  std::string log(4096, '\0');
  GLsizei length = 0;
  glGetProgramInfoLog(program.id(), static_cast<GLsizei>(log.size()), &length, log.data());
  throw Error("the GPU does not link the program " + std::string(name) + ": " + log.substr(0, log.find('\n')));
}

}  // namespace

Program::Program(std::string_view name, const std::vector<Stage>& stages) {
  std::vector<std::string> texts;
  std::string all;
  for (const Stage& stage : stages) all += texts.emplace_back(assemble(stage));
  const ProgramCache cache(all);
  object_ = cache.load();
  cached_ = object_.id() != 0;
  if (cached_) return;
  object_ = ProgramObject(glCreateProgram());
  for (std::size_t i = 0; i < stages.size(); ++i)  // a shader lives on while its program needs it
    glAttachShader(id(), compile(name, stages[i], texts[i]).id());
  link(name, object_);
  cache.store(object_);
}

Program make_screen_program(std::string_view name, Stage fragment) {
  fragment.type = GL_FRAGMENT_SHADER;
  return Program(name, {{GL_VERTEX_SHADER, {"gpu/shaders/screen.vert.glsl"}, {}}, std::move(fragment)});
}

void draw_everywhere(float depth) {
  glUniform1f(0, depth);  // explicit location in screen.vert.glsl
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace rayengine
