#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace rayengine {

/// A file that is in memory alone, for libraries that write to nothing but a file by its name. Linux's memfd_create.
class MemoryFile {
 public:
  /// Throws Error where there is no room for `most` bytes: those who write to it might not notice.
  explicit MemoryFile(std::size_t most);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// What any function that opens files in this process takes.
  std::string name() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

  /// All that was written. Throws Error when it cannot be read.
  std::vector<unsigned char> content() const;

 private:
  int descriptor_;
};

}  // namespace rayengine
