#pragma once

#include <filesystem>
#include <fstream>

namespace rayengine {

/// Throws Error when `file` cannot be written: to be called before the work, so that it is not lost.
void check_file_writable(const std::filesystem::path& file);

/// A file that gets its name only when it is complete: written under a temporary name beside it, and renamed. What is
/// there already and no plain file, as /dev/stdout, is written to directly.
class AtomicFile {
 public:
  /// Opens the temporary. Throws Error.
  explicit AtomicFile(const std::filesystem::path& file);
  /// Removes the temporary, unless it was committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write: by stream, or by name for writers that open files themselves. It has the extension of the file.
  std::ostream& stream() { return stream_; }
  const std::filesystem::path& temporary() const { return temporary_; }

  /// Closes and renames. Throws Error when something was not written, as on a full disk.
  void commit();

 private:
  std::filesystem::path file_, temporary_;
  std::ofstream stream_;
  bool in_place_, committed_ = false;
};

/// Removes the temporaries of all files that are being written; for signal handlers, so it takes no lock and no memory.
void remove_temporaries() noexcept;

}  // namespace rayengine
