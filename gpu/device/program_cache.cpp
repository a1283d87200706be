#include "gpu/device/program_cache.h"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace rayengine {
namespace {

namespace fs = std::filesystem;

fs::path cache_folder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return fs::path(cache) / "rayengine";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "rayengine";
  return {};
}

/// FNV-1a. Source: Fowler, Noll, Vo, "The FNV Non-Cryptographic Hash Algorithm".
std::uint64_t fnv1a(const std::string& text, std::uint64_t hash) {
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

std::string gl_text(GLenum name) { return reinterpret_cast<const char*>(glGetString(name)); }

bool gives_binaries() {
  GLint formats = 0;
  glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
  return formats > 0;
}

}  // namespace

ProgramCache::ProgramCache(const std::string& sources) {
  const fs::path folder = cache_folder();
  if (folder.empty() || !gives_binaries()) return;
  const std::string key = gl_text(GL_VENDOR) + gl_text(GL_RENDERER) + gl_text(GL_VERSION) + sources;
  char name[48];  // two bases make 128 bits of one hash of 64
  std::snprintf(name, sizeof name, "%016llx%016llx.program",
                static_cast<unsigned long long>(fnv1a(key, 0xcbf29ce484222325u)),
                static_cast<unsigned long long>(fnv1a(key, 0x9e3779b97f4a7c15u)));
  path_ = folder / name;
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
  std::error_code ignored;
  fs::create_directories(fs::path(path_).parent_path(), ignored);
  // Others may be reading, and other threads writing the same.
  static std::atomic<unsigned> stored = 0;
  const std::string unfinished = path_ + "." + std::to_string(getpid()) + "." + std::to_string(stored++);
  std::ofstream file(unfinished, std::ios::binary);
  file.write(reinterpret_cast<const char*>(&format), sizeof format).write(binary.data(), size);
  file.close();
  if (file) fs::rename(unfinished, path_, ignored);
  if (!file || ignored) fs::remove(unfinished, ignored);
}

}  // namespace rayengine
