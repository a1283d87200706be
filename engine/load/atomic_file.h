#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

namespace rayengine {

/// Throws Error when `file` cannot be written: to be called before the work, so that it is not lost.
void check_output(const std::filesystem::path& file);

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

  /// Appends. Throws Error, on a full disk for one.
  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// Ends the writing and gives the file its name. Throws Error.
  void commit();

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path file_, temporary_;
  std::ofstream stream_;
  bool in_place_, committed_ = false;
};

/// Removes the temporaries of all files that are being written; for signal handlers, so it takes no lock and no memory.
void remove_temporaries() noexcept;

}  // namespace rayengine
