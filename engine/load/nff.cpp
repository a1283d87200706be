#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "engine/load/complete.h"
#include "engine/load/load.h"
#include "engine/load/nff_cone.h"
#include "engine/load/place.h"
#include "engine/load/polygon.h"
#include "engine/load/text.h"

// Eric Haines' Neutral File Format, after NFF.TXT 3.9. Surfaces are two-sided here.
namespace rayengine {
namespace {

class NffReader {
 public:
  explicit NffReader(const std::filesystem::path& file) : file_(file), data_(read_file(file)), in_(data_, file, '#') {}

  Scene read() {
    while (in_.more()) entity();
    if (scene_.materials.empty()) scene_.materials.emplace_back();
    for (const std::size_t i : lights_without_color_)
      scene_.lights[i].color = glm::vec3(1 / std::sqrt(static_cast<float>(scene_.lights.size())));
    scene_.geometry = builder_.build();
    complete(scene_, has_camera_);
    return std::move(scene_);
  }

 private:
  void entity() {
    const std::string_view name = in_.word();
    const Place place{file_, in_.line()};
    if (name == "v") return viewpoint(place);
    if (name == "b") return background();
    if (name == "l") return light();
    if (name == "f") return material(place);
    if (name == "s") return sphere(place);
    if (name == "c") return cone(place);
    if (name == "p" || name == "pp") return polygon(place, name == "pp");
    // How finely others should facet their curves; ours are exact.
    if (name == "tess") return void(number());
    if (name == "tet" || name == "hex" || name == "oct" || name == "dod" || name == "ico")
      fail(place, quoted(name) + " is not of standard NFF; give its faces as polygons (p)");
    fail(place, quoted(name) + " is no entity of NFF; use v, b, l, f, s, c, p or pp");
  }

  double number() { return in_.to_finite(in_.word()); }
  glm::dvec3 point() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }

  /// The word that comes next, left in its place; empty at the end of the file.
  std::string_view peek() const {
    Text ahead = in_;
    return ahead.more() ? ahead.word() : std::string_view();
  }
  bool number_is_next() const { return peek().find_first_of("0123456789") <= 2; }  // behind a sign and a point at most

  float factor() {
    const auto value = static_cast<float>(number());
    if (!(value >= 0 && std::isfinite(value))) in_.fail("a factor is negative or too large");
    return value;
  }
  glm::vec3 color() {
    const float r = factor(), g = factor(), b = factor();
    return {r, g, b};
  }

  void viewpoint(const Place& place) {
    if (has_camera_) fail(place, "a second viewpoint; keep one");
    has_camera_ = true;
    Camera& camera = scene_.camera;
    bool from = false, at = false;
    for (;;) {
      const std::string_view key = peek();
      if (key == "from")
        from = true, camera.from = viewpoint_vector();
      else if (key == "at")
        at = true, camera.at = viewpoint_vector();
      else if (key == "up")
        camera.up = viewpoint_vector();
      else if (key == "angle")
        in_.word(), camera.fov = number();
      else if (key == "hither")
        in_.word(), number();  // nothing is cut off
      else if (key == "resolution")
        in_.word(), camera.size.x = side(), camera.size.y = side();
      else
        break;
    }
    if (!from || !at) fail(place, "a viewpoint lacks 'from' or 'at'; give both");
    at_place(place, [&] { check(camera); });
  }

  glm::dvec3 viewpoint_vector() {
    in_.word();
    return point();
  }

  int side() {
    const std::int64_t pixels = in_.to_integer(in_.word());
    return static_cast<int>(std::clamp<std::int64_t>(pixels, 0, 1 << 30));  // judged with the rest of the camera
  }

  void background() { scene_.background.color = color(); }

  void light() {
    Light light;
    light.position = point();
    if (number_is_next())
      light.color = color();
    else
      lights_without_color_.push_back(scene_.lights.size());
    scene_.lights.push_back(light);
  }

  void material(const Place& place) {
    std::array<float, 8> f{};  // r g b Kd Ks Shine T ior
    const glm::vec3 rgb = color();
    for (int i = 0; i < 3; ++i) f[i] = rgb[i];
    for (int i = 3; i < 7; ++i) f[i] = factor();
    if (number_is_next())
      f[7] = factor();
    else if (f[6] > 0)
      fail(place, "a transparent material has 7 numbers; give its index of refraction, the eighth");
    skip_texture();
    current_ = index_of(f);
  }

  /// Some files end `f` with the name of a picture.
  void skip_texture() {
    if (!in_.more_on_line() || peek().find('.') == std::string_view::npos) return;
    const std::string_view name = in_.word();
    scene_.notes.push_back(file_.string() + ":" + std::to_string(in_.line()) + ": texture " + quoted(name) +
                           " is left out");
  }

  std::uint32_t index_of(const std::array<float, 8>& f) {
    const auto [found, is_new] = indices_.try_emplace(f, static_cast<std::uint32_t>(scene_.materials.size()));
    if (is_new) scene_.materials.push_back(make_material(f));
    return found->second;
  }

  static Material make_material(const std::array<float, 8>& f) {
    // Shine is the cosine power about the mirror direction. About the half vector, whose angle is half as large, four
    // times the power gives a highlight of the same width. 100000 stands for no highlight.
    const bool has_highlight = f[5] < 100000;
    Material m;
    m.color = {f[0], f[1], f[2]};
    m.diffuse = f[3];
    m.specular = has_highlight ? f[4] : 0;
    m.shininess = has_highlight ? 4 * f[5] : m.shininess;
    m.reflect = f[4];
    m.transmit = f[6];
    m.ior = f[7] > 0 ? f[7] : 1;
    return m;
  }

  /// The material of the object at hand: what the last `f` said, or the default one before the first.
  std::uint32_t current() {
    if (!current_) {
      current_ = static_cast<std::uint32_t>(scene_.materials.size());
      scene_.materials.emplace_back();
    }
    return *current_;
  }

  void sphere(const Place& place) {
    const glm::dvec3 center = point();
    const double radius = std::abs(number());
    if (radius == 0) fail(place, "a sphere has no radius; give it one");
    at_place(place, [&] { builder_.add(QuadricShape{}, current(), {glm::dmat3(radius), center}); });
  }

  void cone(const Place& place) {
    const glm::dvec3 base = point();
    const double base_radius = number();
    const glm::dvec3 apex = point();
    const double apex_radius = number();
    at_place(place, [&] {
      const PlacedQuadric placed = frustum(base, base_radius, apex, apex_radius);
      builder_.add(placed.shape, current(), placed.to_world);
    });
  }

  void polygon(const Place& place, bool has_normals) {
    const std::int64_t count = in_.to_integer(in_.word());
    if (count < 3) fail(place, "a polygon has " + std::to_string(count) + " vertices; it needs at least 3");
    Mesh mesh;  // grows as vertices really come, whatever the count promises
    for (std::int64_t i = 0; i < count; ++i) {
      mesh.positions.push_back(point());
      if (has_normals) mesh.normals.emplace_back(point());
    }
    at_place(place, [&] {
      mesh.triangles = triangulate(mesh.positions);
      builder_.add(mesh, current());
    });
  }

  const std::filesystem::path& file_;
  std::string data_;
  Text in_;
  Scene scene_{.camera = {}, .background = {}, .lights = {}, .materials = {}, .geometry = {}, .notes = {}};
  GeometryBuilder builder_;
  bool has_camera_ = false;
  std::vector<std::size_t> lights_without_color_;
  std::map<std::array<float, 8>, std::uint32_t> indices_;
  std::optional<std::uint32_t> current_;
};

}  // namespace

Scene load_nff(const std::filesystem::path& file) { return NffReader(file).read(); }

}  // namespace rayengine
