#include "engine/load/mesh_files.h"

#include <algorithm>
#include <fstream>
#include <string>

namespace rayengine {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t hash_length = 32;

/// So that a look at the names tells what need not be hashed.
std::string prefix(std::size_t triangles) { return std::to_string(triangles) + "-"; }

/// Others keep theirs in the same folder.
bool is_mesh_file(const fs::path& file) { return file.extension() == ".mesh" || file.extension() == ".quadrics"; }

std::uintmax_t size_of(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  return error ? 0 : size;
}

/// Removes the files that were unused for longest until the rest is within the limit. Others may do so at once.
void make_room(const fs::path& folder) {
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  std::uintmax_t total = 0;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (!is_mesh_file(entry.path())) continue;
    files.emplace_back(entry.last_write_time(ignored), entry.path());
    total += size_of(entry.path());
  }
  std::ranges::sort(files);
  for (const auto& [time, file] : files) {
    if (total <= mesh_files_limit) break;
    total -= std::min(total, size_of(file));
    fs::remove(file, ignored);
  }
}

}  // namespace

fs::path mesh_file(const Mesh& mesh, Bytes way, std::string_view extension) {
  const fs::path folder = cache_folder();
  if (folder.empty()) return {};
  ContentHash hash;
  hash.add(way).add(bytes_of(mesh.positions)).add(bytes_of(mesh.normals)).add(bytes_of(mesh.triangles));
  return folder / (prefix(mesh.triangles.size()) + hash.name() + std::string(extension));
}

bool may_have_mesh_file(std::size_t triangles) {
  std::error_code ignored;
  const std::string start = prefix(triangles);
  for (const auto& entry : fs::directory_iterator(cache_folder(), ignored))
    if (entry.path().filename().string().starts_with(start)) return true;
  return false;
}

std::optional<std::vector<char>> read_mesh_file(const fs::path& file) {
  if (file.empty()) return {};
  std::vector<char> content(size_of(file));
  std::ifstream stream(file, std::ios::binary);
  if (content.size() < hash_length || !stream.read(content.data(), std::streamsize(content.size()))) return {};
  const std::string hash(content.end() - hash_length, content.end());
  content.resize(content.size() - hash_length);
  if (ContentHash().add(bytes_of(content)).name() != hash) return {};
  std::error_code ignored;
  fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
  return content;
}

void write_mesh_file(const fs::path& file, std::initializer_list<Bytes> parts) {
  if (file.empty()) return;
  std::vector<std::byte> content;
  for (const Bytes part : parts) content.insert(content.end(), part.begin(), part.end());
  const std::string hash = ContentHash().add(content).name();
  if (write_cache_file(file, {content, std::as_bytes(std::span(hash))})) make_room(file.parent_path());
}

}  // namespace rayengine
