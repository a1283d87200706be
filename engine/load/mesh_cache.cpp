#include "engine/load/mesh_cache.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <string>

#include "accel/cache_folder.h"

namespace rayengine {
namespace {

namespace fs = std::filesystem;

constexpr char extension[] = ".mesh";

/// Followed by positions, normals, triangles and the name of their hash. No triangles: the mesh itself.
struct Header {
  char format[8] = {'R', 'a', 'y', 'L', 'o', 'D', '0', '1'};
  std::uint64_t positions = 0, normals = 0, triangles = 0;
  double distance = 0;
};
constexpr std::size_t hash_length = 32;

template <class T>
Bytes bytes(const std::vector<T>& list) {
  return std::as_bytes(std::span(list));
}
template <class T>
Bytes bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

/// So that a look at the names tells what need not be hashed.
std::string prefix(std::size_t triangles) { return std::to_string(triangles) + "-"; }

fs::path file_of(const Mesh& mesh, double tolerance, std::size_t most_decimated) {
  const fs::path folder = cache_folder();
  if (folder.empty()) return {};
  ContentHash hash;
  hash.add(bytes_of(Header().format)).add(bytes_of(tolerance)).add(bytes_of(most_decimated));
  hash.add(bytes(mesh.positions)).add(bytes(mesh.normals)).add(bytes(mesh.triangles));
  return folder / (prefix(mesh.triangles.size()) + hash.name() + extension);
}

std::string hash_of(const Header& header, const Mesh& mesh) {
  ContentHash hash;
  hash.add(bytes_of(header)).add(bytes(mesh.positions)).add(bytes(mesh.normals)).add(bytes(mesh.triangles));
  return hash.name();
}

template <class T>
bool read(std::istream& stream, std::vector<T>& list, std::uint64_t count) {
  list.resize(count);
  return static_cast<bool>(stream.read(reinterpret_cast<char*>(list.data()), std::streamsize(count * sizeof(T))));
}

/// Whether a file of that size can hold what its header says; without overflow, for it may say anything.
bool fits(const Header& header, std::uintmax_t size) {
  const std::uint64_t most = size / sizeof(glm::uvec3);
  if (header.positions > most || header.normals > most || header.triangles > most) return false;
  return size == sizeof header + hash_length + header.positions * sizeof(glm::dvec3) +
                     header.normals * sizeof(glm::vec3) + header.triangles * sizeof(glm::uvec3);
}

std::optional<CoarserMesh> read_file(const fs::path& file, const Mesh& original) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  Header header;
  if (error || !stream.read(reinterpret_cast<char*>(&header), sizeof header)) return {};
  if (std::memcmp(header.format, Header().format, sizeof header.format) != 0 || !fits(header, size)) return {};
  CoarserMesh found{{}, header.distance};
  std::string hash(hash_length, ' ');
  if (!read(stream, found.mesh.positions, header.positions) || !read(stream, found.mesh.normals, header.normals) ||
      !read(stream, found.mesh.triangles, header.triangles) || !stream.read(hash.data(), hash_length) ||
      hash != hash_of(header, found.mesh))
    return {};
  for (const glm::uvec3& t : found.mesh.triangles)
    if (std::max({t.x, t.y, t.z}) >= header.positions) return {};
  if (found.mesh.triangles.empty()) found.mesh = original;
  return found;
}

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
    if (entry.path().extension() != extension) continue;
    files.emplace_back(entry.last_write_time(ignored), entry.path());
    total += size_of(entry.path());
  }
  std::ranges::sort(files);
  for (const auto& [time, file] : files) {
    if (total <= mesh_cache_limit) break;
    total -= std::min(total, size_of(file));
    fs::remove(file, ignored);
  }
}

void write_file(const fs::path& file, const CoarserMesh& simplified, bool is_the_original) {
  const Mesh none;
  const Mesh& mesh = is_the_original ? none : simplified.mesh;
  const Header header{.positions = mesh.positions.size(),
                      .normals = mesh.normals.size(),
                      .triangles = mesh.triangles.size(),
                      .distance = simplified.distance};
  const std::string hash = hash_of(header, mesh);
  if (write_cache_file(file, {bytes_of(header), bytes(mesh.positions), bytes(mesh.normals), bytes(mesh.triangles),
                              std::as_bytes(std::span(hash))}))
    make_room(file.parent_path());
}

std::optional<CoarserMesh> find(const fs::path& file, const Mesh& mesh) {
  if (file.empty()) return {};
  std::optional<CoarserMesh> found = read_file(file, mesh);
  std::error_code ignored;
  if (found) fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
  return found;
}

}  // namespace

bool may_have_simplified(std::size_t triangles) {
  std::error_code ignored;
  const std::string start = prefix(triangles);
  for (const auto& entry : fs::directory_iterator(cache_folder(), ignored))
    if (entry.path().filename().string().starts_with(start)) return true;
  return false;
}

std::optional<CoarserMesh> find_simplified(const Mesh& mesh, double tolerance, std::size_t most_decimated) {
  return find(file_of(mesh, tolerance, most_decimated), mesh);
}

CoarserMesh simplify_cached(const Mesh& mesh, double tolerance, std::size_t most_decimated) {
  const fs::path file = file_of(mesh, tolerance, most_decimated);
  if (auto found = find(file, mesh)) return *std::move(found);
  CoarserMesh result = simplify(mesh, tolerance, most_decimated);
  if (!file.empty()) write_file(file, result, result.mesh.triangles.size() == mesh.triangles.size());
  return result;
}

}  // namespace rayengine
