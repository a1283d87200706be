#pragma once

#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

#include "accel/cache_folder.h"
#include "accel/geometry.h"

// Files in the cache folder that hold what was made of meshes: named by their number of triangles and a hash of all
// that it was made of, and ending in a hash of what they hold.
namespace rayengine {

/// Bytes that they may take; those unused for longest go first.
inline constexpr std::uintmax_t mesh_files_limit = std::uintmax_t{512} << 20;

template <class T>
Bytes bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}
template <class T>
Bytes bytes_of(const std::vector<T>& list) {
  return std::as_bytes(std::span(list));
}

/// The file of what is made of a mesh in such a way; empty without a cache folder. The extension is .mesh or .quadrics.
std::filesystem::path mesh_file(const Mesh& mesh, Bytes way, std::string_view extension);

/// Whether anything is kept that was made of a mesh of so many triangles: quick, for there mostly is not.
bool may_have_mesh_file(std::size_t triangles);

/// What a file holds, if it is whole: it is the last to go now.
std::optional<std::vector<char>> read_mesh_file(const std::filesystem::path& file);

/// Keeps `parts`, one after the other. That this may fail is no error.
void write_mesh_file(const std::filesystem::path& file, std::initializer_list<Bytes> parts);

/// Takes values off the front of what a file holds, as far as there is any.
class MeshFileReader {
 public:
  explicit MeshFileReader(const std::vector<char>& bytes) : at_(bytes.data()), left_(bytes.size()) {}

  template <class T>
  bool read(T& value) {
    return take(&value, sizeof value);
  }
  template <class T>
  bool read(std::vector<T>& list, std::uint64_t count) {
    if (count > left_ / sizeof(T)) return false;
    list.resize(count);
    return take(list.data(), count * sizeof(T));
  }
  bool at_end() const { return left_ == 0; }

 private:
  bool take(void* to, std::size_t size) {
    if (size > left_) return false;
    if (size > 0) std::memcpy(to, at_, size);
    at_ += size, left_ -= size;
    return true;
  }

  const char* at_;
  std::size_t left_;
};

}  // namespace rayengine
