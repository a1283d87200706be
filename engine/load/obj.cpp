// Wavefront OBJ: v, vn and f; texture coordinates, groups, lines, points and materials are passed over.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/load/face_list.h"
#include "engine/load/text.h"

namespace rayengine {
namespace {

constexpr std::array<std::string_view, 37> passed_over = {
    "vt",     "vp",    "g",        "o",        "s",          "l",         "p",      "mg",  "lod",  "usemap",
    "maplib", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj", "cstype", "deg", "bmat", "step",
    "curv",   "curv2", "surf",     "parm",     "trim",       "hole",      "scrv",   "sp",  "end",  "con",
    "ctech",  "stech", "bsp",      "bzp",      "cdc",        "cdp",       "res"};

// Indices may name what only comes later in the file, so that the largest is checked at its end.
struct Largest {
  std::uint32_t index = 0;
  std::uint64_t line = 0;

  std::uint32_t seen(std::uint32_t i, std::uint64_t at) {
    if (i >= index) index = i, line = at;
    return i;
  }
};

class ObjReader {
 public:
  ObjReader(std::string_view data, const std::filesystem::path& file) : text_(data, file, '#') {}

  FaceList read() {
    while (text_.more()) {
      statement(text_.word_on_line());
      while (text_.more_on_line()) text_.word_on_line();  // follows continued lines, as rest_of_line() would not
    }
    check(position_, list_.positions.size(), "vertices");
    check(normal_, list_.normals.size(), "normals");
    if (!normal_.line) list_.normals.clear(), list_.triangle_normals.clear();
    return std::move(list_);
  }

 private:
  void statement(std::string_view keyword) {
    if (keyword == "v") return list_.positions.push_back(position());
    if (keyword == "vn") return list_.normals.push_back(normal());
    if (keyword == "f") return face();
    if (keyword == "usemtl" || keyword == "mtllib") {
      list_.has_materials = true;
    } else if (std::ranges::find(passed_over, keyword) == passed_over.end()) {
      text_.fail(quoted(keyword) + " is not a statement of the OBJ format");
    }
  }

  glm::dvec3 position() {
    if (list_.positions.size() >= max_vertices) text_.fail("more vertices than 32-bit indices can name");
    glm::dvec3 p;
    for (int k = 0; k < 3; ++k) p[k] = text_.to_finite(text_.word_on_line());
    return p;
  }

  glm::vec3 normal() {
    if (list_.normals.size() >= max_vertices) text_.fail("more normals than 32-bit indices can name");
    glm::vec3 n;
    for (int k = 0; k < 3; ++k) n[k] = static_cast<float>(text_.to_number(text_.word_on_line()));
    return n;
  }

  void face() {
    Fan fan(list_);
    while (text_.more_on_line()) {
      const std::string_view corner = text_.word_on_line();  // v, v/vt, v//vn or v/vt/vn
      const std::size_t slash = std::min(corner.find('/'), corner.size());
      const std::uint32_t position = index(corner.substr(0, slash), list_.positions.size());
      const std::size_t second = std::min(corner.find('/', slash + 1), corner.size());
      std::uint32_t normal = no_id;
      if (second + 1 < corner.size())
        normal = normal_.seen(index(corner.substr(second + 1), list_.normals.size()), text_.line());
      fan.add(position_.seen(position, text_.line()), normal);
    }
  }

  // Indices count from 1, or back from the latest entry when negative.
  std::uint32_t index(std::string_view word, std::size_t count) const {
    const std::int64_t i = text_.to_integer(word);
    const std::int64_t size = static_cast<std::int64_t>(count);
    if (i == 0 || i < -size || i > static_cast<std::int64_t>(max_vertices))
      text_.fail("index " + std::to_string(i) + " is out of range");
    return static_cast<std::uint32_t>(i > 0 ? i - 1 : size + i);
  }

  void check(const Largest& largest, std::size_t count, const char* what) const {
    if (largest.line && largest.index >= count)
      text_.fail_at(largest.line, "index " + std::to_string(largest.index + 1ull) + " is out of range: the file has " +
                                      std::to_string(count) + " " + what);
  }

  Text text_;
  FaceList list_;
  Largest position_, normal_;
};

}  // namespace

FaceList read_obj(std::string_view data, const std::filesystem::path& file) { return ObjReader(data, file).read(); }

}  // namespace rayengine
