#include "gpu/device/program_cache.h"

#include <fstream>
#include <iterator>
#include <vector>

#include "accel/cache_folder.h"

namespace rayengine {
namespace {

std::string gl_text(GLenum name) { return reinterpret_cast<const char*>(glGetString(name)); }

bool gives_binaries() {
  GLint formats = 0;
  glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
  return formats > 0;
}

}  // namespace

ProgramCache::ProgramCache(const std::string& sources) {
  const std::filesystem::path folder = cache_folder();
  if (folder.empty() || !gives_binaries()) return;
  const std::string key = gl_text(GL_VENDOR) + gl_text(GL_RENDERER) + gl_text(GL_VERSION) + sources;
  path_ = folder / (ContentHash().add(std::as_bytes(std::span(key))).name() + ".program");
}

ProgramObject ProgramCache::load() const {
  std::ifstream file(path_, std::ios::binary);
  GLenum format = 0;
  if (path_.empty() || !file.read(reinterpret_cast<char*>(&format), sizeof format)) return {};
  const std::vector<char> binary(std::istreambuf_iterator<char>(file), {});
  ProgramObject program(glCreateProgram());
  glProgramBinary(program.id(), format, binary.data(), static_cast<GLsizei>(binary.size()));
  GLint linked = 0;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
  if (linked) return program;
  glGetError();  // a binary of another driver is not an error of ours
  return {};
}

void ProgramCache::store(const ProgramObject& program) const {
  GLint size = 0;
  glGetProgramiv(program.id(), GL_PROGRAM_BINARY_LENGTH, &size);
  if (path_.empty() || size <= 0) return;
  std::vector<char> binary(static_cast<std::size_t>(size));
  GLenum format = 0;
  glGetProgramBinary(program.id(), size, nullptr, &format, binary.data());
  write_cache_file(path_, {std::as_bytes(std::span(&format, 1)), std::as_bytes(std::span(binary))});
}

}  // namespace rayengine
