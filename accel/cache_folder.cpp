#include "accel/cache_folder.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace rayengine {
namespace {

namespace fs = std::filesystem;

/// A step of one lane: multiplied by an odd number, and its high bits, which all lower ones reach, brought down again.
std::uint64_t mixed(std::uint64_t state, std::uint64_t word, std::uint64_t odd) {
  state = (state ^ word) * odd;
  return state ^ state >> 32;
}

bool write(const fs::path& file, std::initializer_list<Bytes> parts) {
  std::ofstream stream(file, std::ios::binary);
  for (const Bytes part : parts)
    stream.write(reinterpret_cast<const char*>(part.data()), static_cast<std::streamsize>(part.size()));
  stream.close();
  return static_cast<bool>(stream);
}

}  // namespace

fs::path cache_folder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return fs::path(cache) / "rayengine";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "rayengine";
  return {};
}

ContentHash& ContentHash::add(Bytes bytes) {
  const auto take = [this](std::uint64_t word) {
    low_ = mixed(low_, word, 0xff51afd7ed558ccdu);
    high_ = mixed(high_, word, 0xc4ceb9fe1a85ec53u);
  };
  take(bytes.size());  // where one part ends and the next begins
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
    take(word);
  }
  return *this;
}

std::string ContentHash::name() const {
  char digits[33];
  std::snprintf(digits, sizeof digits, "%016llx%016llx", static_cast<unsigned long long>(high_),
                static_cast<unsigned long long>(low_));
  return digits;
}

bool write_cache_file(const fs::path& file, std::initializer_list<Bytes> parts) {
  std::error_code ignored;
  fs::create_directories(file.parent_path(), ignored);
  // Others may be reading, and other threads writing the same.
  static std::atomic<unsigned> written = 0;
  const fs::path unfinished = file.string() + "." + std::to_string(getpid()) + "." + std::to_string(written++);
  std::error_code error;
  const bool complete = write(unfinished, parts);
  if (complete) fs::rename(unfinished, file, error);
  if (complete && !error) return true;
  fs::remove(unfinished, ignored);
  return false;
}

}  // namespace rayengine
