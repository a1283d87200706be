#include "engine/load/atomic_file.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>

#include "accel/tracer.h"

namespace rayengine {
namespace {

namespace fs = std::filesystem;

/// Names of open temporaries; what does not fit is merely not removed when a signal ends the program.
std::array<std::atomic<const char*>, 16> open_names;

void enlist(const char* name) {
  for (auto& slot : open_names)
    if (const char* none = nullptr; slot.compare_exchange_strong(none, name)) return;
}

void strike(const char* name) {
  for (auto& slot : open_names)
    if (const char* expected = name; slot.compare_exchange_strong(expected, nullptr)) return;
}

[[noreturn]] void fail(const fs::path& file, int error) {
  throw Error("cannot write " + file.string() + ": " + std::strerror(error) + "; choose another place");
}

bool is_special(const fs::path& file) {
  std::error_code none;
  return fs::exists(file, none) && !fs::is_regular_file(file, none);
}

/// Follows links, so that a link stays one and its target is replaced.
fs::path target(const fs::path& file) {
  std::error_code none;
  return fs::is_symlink(file, none) ? fs::weakly_canonical(file) : file;
}

fs::path temporary_name(const fs::path& file) {
  static std::atomic<int> count = 0;
  std::string name = ".";
  name += file.stem().string() + "." + std::to_string(getpid()) + "." + std::to_string(count++);
  return file.parent_path() / (name + file.extension().string());
}

}  // namespace

void check_output(const fs::path& file) {
  if (file.filename().empty() || fs::is_directory(file)) fail(file, EISDIR);
  const fs::path folder = file.parent_path().empty() ? "." : file.parent_path();
  if (!fs::is_directory(folder)) fail(file, fs::exists(folder) ? ENOTDIR : ENOENT);
  if (is_special(file) || fs::exists(file)) {
    if (access(file.c_str(), W_OK) != 0) fail(file, errno);
  }
  if (!is_special(file) && access(folder.c_str(), W_OK | X_OK) != 0) fail(file, errno);
}

AtomicFile::AtomicFile(const fs::path& file)
    : file_(target(file)), temporary_(is_special(file_) ? file_ : temporary_name(file_)), in_place_(is_special(file_)) {
  check_output(file);
  if (!in_place_) enlist(temporary_.c_str());
  stream_.open(temporary_, std::ios::binary);
  if (!stream_) {
    const int error = errno;
    strike(temporary_.c_str());
    rayengine::fail(file, error);
  }
}

AtomicFile::~AtomicFile() {
  if (in_place_ || committed_) return;
  std::error_code none;
  fs::remove(temporary_, none);
  strike(temporary_.c_str());
}

void AtomicFile::fail() const { rayengine::fail(file_, errno ? errno : ENOSPC); }

void AtomicFile::write(const void* data, std::size_t size) {
  errno = 0;
  if (!stream_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size))) fail();
}

void AtomicFile::commit() {
  errno = 0;
  stream_.close();
  if (!stream_) fail();
  if (in_place_) return;
  std::error_code error;
  fs::rename(temporary_, file_, error);
  if (error) rayengine::fail(file_, error.value());
  strike(temporary_.c_str());
  committed_ = true;
}

void remove_temporaries() noexcept {
  for (auto& slot : open_names)
    if (const char* name = slot.exchange(nullptr)) unlink(name);
}

}  // namespace rayengine
