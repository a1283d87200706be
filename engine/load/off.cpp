// Object File Format, ASCII: OFF with the prefixes ST, C and N, of which the normals are kept.
#include <cmath>

#include "engine/load/face_list.h"
#include "engine/load/text.h"

namespace rayengine {
namespace {

bool take_prefix(std::string_view& word, std::string_view prefix) {
  if (!word.starts_with(prefix)) return false;
  word.remove_prefix(prefix.size());
  return true;
}

/// Reads the first word; true when vertices have normals.
bool read_keyword(Text& text) {
  const std::string_view keyword = text.word();
  std::string_view rest = keyword;
  take_prefix(rest, "ST");
  take_prefix(rest, "C");
  const bool normals = take_prefix(rest, "N");
  if (rest != "OFF") text.fail("expected OFF, found " + quoted(keyword) + "; other kinds of OFF are not read");
  return normals;
}

// Every entry takes two characters at least, so that no count can ask for more memory than the file's size warrants.
std::uint64_t read_count(Text& text, const char* what) {
  const std::string_view word = text.word();
  if (word == "BINARY") text.fail("binary OFF is not read; save as ASCII OFF or as PLY");
  const std::int64_t count = text.to_integer(word);
  if (count < 0 || static_cast<std::uint64_t>(count) > text.remaining() / 2 ||
      static_cast<std::uint64_t>(count) > max_vertices)
    text.fail(std::to_string(count) + " " + what + " do not fit into the file");
  return static_cast<std::uint64_t>(count);
}

void read_vertex(Text& text, FaceList& list, bool normals) {
  glm::dvec3 p;
  for (int k = 0; k < 3; ++k) p[k] = text.to_finite(text.word());
  list.positions.push_back(p);
  if (!normals) return;
  glm::vec3 n;
  for (int k = 0; k < 3; ++k) n[k] = static_cast<float>(text.to_number(text.word()));
  list.normals.push_back(n);
}

void read_face(Text& text, FaceList& list) {
  const std::int64_t corners = text.to_integer(text.word());
  if (corners < 0) text.fail("a face of " + std::to_string(corners) + " corners");
  Fan fan(list);
  for (std::int64_t c = 0; c < corners; ++c) {
    const std::int64_t i = text.to_integer(text.word());
    if (i < 0 || static_cast<std::size_t>(i) >= list.positions.size())
      text.fail("index " + std::to_string(i) + " is out of range: the file has " +
                std::to_string(list.positions.size()) + " vertices");
    fan.add(static_cast<std::uint32_t>(i));
  }
}

}  // namespace

FaceList read_off(std::string_view data, const std::filesystem::path& file) {
  Text text(data, file, '#');
  const bool normals = read_keyword(text);
  const std::uint64_t vertices = read_count(text, "vertices"), faces = read_count(text, "faces");
  text.rest_of_line();  // the number of edges, which nobody needs
  FaceList list;
  list.positions.reserve(vertices);
  list.triangles.reserve(faces);
  // What follows on a line, such as colours, is passed over.
  for (std::uint64_t i = 0; i < vertices; ++i, text.rest_of_line()) read_vertex(text, list, normals);
  for (std::uint64_t i = 0; i < faces; ++i, text.rest_of_line()) read_face(text, list);
  return list;
}

}  // namespace rayengine
