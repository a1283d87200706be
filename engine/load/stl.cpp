// STL, binary and ASCII. Equal positions become one vertex; the facets' normals, which follow from them, are passed
// over.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

#include "accel/tracer.h"
#include "engine/load/face_list.h"
#include "engine/load/text.h"
#include "engine/load/weld.h"

namespace rayengine {
namespace {

constexpr std::size_t header_size = 84, facet_size = 50;

class Facets {
 public:
  explicit Facets(std::size_t expected) : weld_(expected / 2) { list_.triangles.reserve(expected); }

  void add(const glm::dvec3 (&corners)[3]) {
    glm::uvec3 triangle;
    for (int k = 0; k < 3; ++k) {
      const auto [vertex, is_new] = weld_.add(corners[k]);
      if (is_new) list_.positions.push_back(corners[k]);
      triangle[k] = vertex;
    }
    list_.triangles.push_back(triangle);
  }

  FaceList take() { return std::move(list_); }

 private:
  FaceList list_;
  Weld weld_;
};

std::uint32_t facet_count(std::string_view data) {
  std::uint32_t count = 0;
  std::memcpy(&count, data.data() + header_size - sizeof count, sizeof count);
  return count;
}

std::size_t binary_size(std::string_view data) { return header_size + facet_size * std::size_t{facet_count(data)}; }

FaceList read_binary(std::string_view data, const std::filesystem::path& file) {
  const std::size_t count = facet_count(data);
  Facets facets(count);
  for (std::size_t i = 0; i < count; ++i) {
    float values[12];  // the normal, then three corners
    std::memcpy(values, data.data() + header_size + i * facet_size, sizeof values);
    glm::dvec3 corners[3];
    for (int k = 0; k < 9; ++k) {
      if (!std::isfinite(values[3 + k]))
        throw Error(file.string() + ": facet " + std::to_string(i) + " has a coordinate that is not finite");
      corners[k / 3][k % 3] = values[3 + k];
    }
    facets.add(corners);
  }
  return facets.take();
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

void expect(Text& text, std::string_view keyword) {
  const std::string_view word = text.word();
  if (!equal_ignoring_case(word, keyword)) text.fail("expected '" + std::string(keyword) + "', found " + quoted(word));
}

void read_facet(Text& text, Facets& facets) {
  text.rest_of_line();  // its normal
  expect(text, "outer");
  expect(text, "loop");
  glm::dvec3 corners[3];
  for (glm::dvec3& corner : corners) {
    expect(text, "vertex");
    for (int k = 0; k < 3; ++k) corner[k] = text.to_finite(text.word());
  }
  expect(text, "endloop");
  expect(text, "endfacet");
  facets.add(corners);
}

void read_solid(Text& text, Facets& facets) {
  expect(text, "solid");
  text.rest_of_line();  // its name
  while (true) {
    const std::string_view word = text.word();
    if (equal_ignoring_case(word, "facet")) {
      read_facet(text, facets);
    } else if (equal_ignoring_case(word, "endsolid")) {
      text.rest_of_line();
      return;
    } else {
      text.fail("expected 'facet' or 'endsolid', found " + quoted(word));
    }
  }
}

FaceList read_ascii(std::string_view data, const std::filesystem::path& file) {
  Text text(data, file);
  Facets facets(data.size() / 250);  // about the length of a facet in print
  do {
    read_solid(text, facets);
  } while (text.more());
  return facets.take();
}

}  // namespace

FaceList read_stl(std::string_view data, const std::filesystem::path& file) {
  // Binary files may begin with "solid" too, so that their size decides.
  if (data.size() >= header_size && data.size() == binary_size(data)) return read_binary(data, file);
  if (equal_ignoring_case(data.substr(0, 5), "solid")) return read_ascii(data, file);
  if (data.size() < header_size)
    throw Error(file.string() + ": is no STL file: neither 'solid' nor a binary header; is it complete?");
  if (data.size() < binary_size(data))
    throw Error(file.string() + ": " + std::to_string(facet_count(data)) +
                " facets do not fit into the file; is it complete?");
  return read_binary(data, file);
}

}  // namespace rayengine
