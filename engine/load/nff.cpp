#include <cmath>
#include <map>

#include "engine/load/complete.h"
#include "engine/load/load.h"
#include "engine/load/nff_cone.h"
#include "engine/load/nff_tokens.h"
#include "engine/load/polygon.h"

// Eric Haines' Neutral File Format, after NFF.TXT 3.9. Surfaces are two-sided here.
namespace rayengine {
namespace {

glm::dvec3 vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

class NffReader {
 public:
  explicit NffReader(const std::filesystem::path& file) : in_(file) {}

  Scene read() {
    while (!in_.at_end()) entity();
    if (scene_.materials.empty()) scene_.materials.emplace_back();
    for (const std::size_t i : lights_without_color_)
      scene_.lights[i].color = glm::vec3(1 / std::sqrt(static_cast<float>(scene_.lights.size())));
    scene_.geometry = builder_.build();
    complete(scene_, has_camera_);
    return std::move(scene_);
  }

 private:
  void entity() {
    const std::string_view name = in_.take();
    const Place place = in_.last_place();
    if (name == "v") return viewpoint(place);
    if (name == "b") return background();
    if (name == "l") return light();
    if (name == "f") return material(place);
    if (name == "s") return sphere(place);
    if (name == "c") return cone(place);
    if (name == "p" || name == "pp") return polygon(place, name == "pp");
    // How finely others should facet their curves; ours are exact.
    if (name == "tess") return void(in_.integer("a tess"));
    if (name == "tet" || name == "hex" || name == "oct" || name == "dod" || name == "ico")
      fail(place, in_quotes(name) + " is not of standard NFF: give its faces as polygons (p)");
    fail(place, "unknown entity " + in_quotes(name) + ": NFF has v, b, l, f, s, c, p and pp");
  }

  glm::dvec3 point(std::string_view what) { return vector(in_.numbers<3>(what)); }

  glm::vec3 color(std::string_view what) {
    const glm::vec3 rgb(point(what));
    for (int i = 0; i < 3; ++i)
      if (!(rgb[i] >= 0 && std::isfinite(rgb[i])))
        fail(in_.last_place(), "a colour is out of range in " + std::string(what));
    return rgb;
  }

  float factor() {
    const auto value = static_cast<float>(in_.number("a material"));
    if (!(value >= 0 && std::isfinite(value))) fail(in_.last_place(), "a factor is out of range in a material");
    return value;
  }

  void viewpoint(const Place& place) {
    if (has_camera_) fail(place, "a second viewpoint: keep one");
    has_camera_ = true;
    Camera& camera = scene_.camera;
    bool from = false, at = false;
    for (;;) {
      const std::string_view key = in_.peek();
      if (key == "from")
        from = true, camera.from = viewpoint_vector();
      else if (key == "at")
        at = true, camera.at = viewpoint_vector();
      else if (key == "up")
        camera.up = viewpoint_vector();
      else if (key == "angle")
        in_.take(), camera.fov = in_.number("a viewpoint's angle");
      else if (key == "hither")
        in_.take(), in_.number("a viewpoint's hither");  // nothing is cut off
      else if (key == "resolution")
        resolution();
      else
        break;
    }
    if (!from || !at) fail(place, "a viewpoint lacks 'from' or 'at': give both");
    at_place(place, [&] { check(camera); });
  }

  glm::dvec3 viewpoint_vector() {
    in_.take();
    return point("a viewpoint");
  }

  void resolution() {
    in_.take();
    const int width = in_.integer("a viewpoint's resolution");
    scene_.camera.size = {width, in_.integer("a viewpoint's resolution")};
  }

  void background() { scene_.background.color = color("a background"); }

  void light() {
    Light light;
    light.position = point("a light");
    if (in_.next_is_number())
      light.color = color("a light");
    else
      lights_without_color_.push_back(scene_.lights.size());
    scene_.lights.push_back(light);
  }

  void material(const Place& place) {
    std::array<float, 8> f{};  // r g b Kd Ks Shine T ior
    const glm::vec3 rgb = color("a material");
    for (int i = 0; i < 3; ++i) f[i] = rgb[i];
    for (int i = 3; i < 7; ++i) f[i] = factor();
    if (in_.next_is_number())
      f[7] = factor();
    else if (f[6] > 0)
      fail(place, "a transparent material has 7 numbers: give its index of refraction, the eighth");
    skip_texture();
    current_ = index_of(f);
  }

  void skip_texture() {
    if (!in_.next_is_on_the_same_line() || in_.peek().find('.') == std::string_view::npos) return;
    const std::string name = in_quotes(in_.take());
    scene_.notes.push_back("texture " + name + " is left out, " + in_.last_place().file.string() + ":" +
                           std::to_string(in_.last_place().line));
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
    const glm::dvec3 center = point("a sphere");
    const double radius = std::abs(in_.number("a sphere"));
    if (radius == 0) fail(place, "a sphere has no radius: give it one");
    at_place(place, [&] { builder_.add(QuadricShape{}, current(), {glm::dmat3(radius), center}); });
  }

  void cone(const Place& place) {
    const glm::dvec3 base = point("a cone");
    const double base_radius = in_.number("a cone");
    const glm::dvec3 apex = point("a cone");
    const double apex_radius = in_.number("a cone");
    at_place(place, [&] {
      const PlacedQuadric placed = frustum(base, base_radius, apex, apex_radius);
      builder_.add(placed.shape, current(), placed.to_world);
    });
  }

  void polygon(const Place& place, bool has_normals) {
    const std::string_view what = has_normals ? "a patch" : "a polygon";
    const int count = in_.integer(what);
    if (count < 3)
      fail(in_.last_place(), std::string(what) + " has " + std::to_string(count) + " vertices: it needs at least 3");
    Mesh mesh;  // grows as vertices really come, whatever the count promises
    for (int i = 0; i < count; ++i) {
      mesh.positions.push_back(point(what));
      if (has_normals) mesh.normals.emplace_back(point(what));
    }
    at_place(place, [&] {
      mesh.triangles = triangulate(mesh.positions);
      builder_.add(mesh, current());
    });
  }

  NffTokens in_;
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
