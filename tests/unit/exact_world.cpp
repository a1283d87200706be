#include "tests/unit/exact_world.h"

#include <cmath>

namespace rayengine::test {
namespace {

Point point(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Dyadic dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Point times(const glm::dmat3& m, const Point& v) {
  Point result{0, 0, 0};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      result[row] = result[row] + Dyadic(m[column][row]) * v[static_cast<std::size_t>(column)];
  return result;
}

/// (x, w)^T Q (y, v)
Dyadic product(const QuadricMatrix& m, const Point& x, double w, const Point& y, double v) {
  const Dyadic left[]{x[0], x[1], x[2], w}, right[]{y[0], y[1], y[2], v};
  constexpr int entry[4][4] = {{0, 1, 2, 3}, {1, 4, 5, 6}, {2, 5, 7, 8}, {3, 6, 8, 9}};
  Dyadic sum = 0;
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 4; ++k) sum = sum + left[i] * Dyadic(m[static_cast<std::size_t>(entry[i][k])]) * right[k];
  return sum;
}

Place fraction(const Dyadic& p, const Dyadic& q, std::uint32_t primitive) {
  Place place;
  place.p = q.sign() < 0 ? -p : p;
  place.q = q.sign() < 0 ? -q : q;
  place.primitive = primitive;
  return place;
}

/// Whether low <= o + t d <= high.
bool within(const Place& t, const Dyadic& o, const Dyadic& d, double low, double high) {
  const auto side = [&](double limit) {  // the sign of o + t d - limit
    return d.sign() == 0 ? (o - limit).sign() : t.compare(Dyadic(limit) - o, d) * d.sign();
  };
  return (std::isinf(low) || side(low) >= 0) && (std::isinf(high) || side(high) <= 0);
}

struct Solid {
  QuadricMatrix matrix;
  glm::dvec3 low{-infinity}, high{infinity};
};

Solid solid_of(const Geometry& geometry, const Quadric& quadric) {
  Solid solid{unit_matrix(quadric.type)};
  if (quadric.type == QuadricType::saddle) solid.low = glm::dvec3(-1), solid.high = glm::dvec3(1);
  if (quadric.type == QuadricType::general) {
    const GeneralForm& form = geometry.forms[quadric.form];
    solid = {form.matrix, form.box.lower, form.box.upper};
  }
  solid.low.z = std::max(solid.low.z, quadric.zmin);
  solid.high.z = std::min(solid.high.z, quadric.zmax);
  return solid;
}

void add_roots(const ExactRay& ray, const Solid& solid, std::vector<Place>& places) {
  const auto& [o, d] = ray;
  const Dyadic a = product(solid.matrix, d, 0, d, 0), b = product(solid.matrix, o, 1, d, 0),
               c = product(solid.matrix, o, 1, o, 1);
  const int discriminant = (b * b - a * c).sign();
  if (discriminant == 0 && a.sign() != 0) {
    places.push_back(fraction(-b, a, 0));
    places.back().is_hit = false;
  }
  if (discriminant <= 0) return;
  if (a.sign() == 0) return places.push_back(fraction(-c, b + b, 0));
  for (const bool upper : {false, true}) {
    Place root;
    root.is_root = true, root.upper = upper;
    const bool flip = a.sign() < 0;
    root.a = flip ? -a : a, root.b = flip ? -b : b, root.c = flip ? -c : c;
    places.push_back(root);
  }
}

/// The plane z = height where `inside` is not positive.
void add_plane(const ExactRay& ray, double height, const QuadricMatrix* inside, std::uint32_t primitive,
               std::vector<Place>& places) {
  const auto& [o, d] = ray;
  if (d[2].sign() == 0) return;
  const Place t = fraction(Dyadic(height) - o[2], d[2], primitive);
  if (inside) {
    // The point in homogeneous coordinates, so that nothing is divided: q o + p d, with q for its w.
    const Point at{t.q * o[0] + t.p * d[0], t.q * o[1] + t.p * d[1], t.q * o[2] + t.p * d[2]};
    const Dyadic quadratic = product(*inside, at, 0, at, 0), linear = product(*inside, at, 0, {0, 0, 0}, 1),
                 constant = product(*inside, {0, 0, 0}, 1, {0, 0, 0}, 1);
    if ((quadratic + (linear + linear) * t.q + constant * t.q * t.q).sign() > 0) return;
  }
  places.push_back(t);
}

/// Whether the line's point at t is in the solid, and not on its surface.
bool is_inside(const ExactRay& ray, const Solid& solid, const Dyadic& t) {
  const auto& [o, d] = ray;
  const Point at{o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]};
  return product(solid.matrix, at, 1, at, 1).sign() < 0 && (at[2] - solid.low.z).sign() > 0 &&
         (at[2] - solid.high.z).sign() < 0;
}

Dyadic before(const Place& place) {
  Dyadic t = -1;
  while (place.compare(t, 1) <= 0) t = t + t;
  return t;
}
Dyadic after(const Place& place) {
  Dyadic t = 1;
  while (place.compare(t, 1) >= 0) t = t + t;
  return t;
}
Dyadic between(const Place& a, const Place& b) {
  for (Dyadic low = before(a), high = after(b);;) {
    const Dyadic middle = Dyadic(0.5) * (low + high);
    if (a.compare(middle, 1) >= 0)
      low = middle;
    else if (b.compare(middle, 1) <= 0)
      high = middle;
    else
      return middle;
  }
}

/// Leaves of sorted places the first hit at each t where the line passes the solid's surface.
std::vector<Place> passages(const ExactRay& ray, const Solid& solid, const std::vector<Place>& places) {
  std::vector<Place> found;
  bool inside = !places.empty() && is_inside(ray, solid, before(places.front()));
  for (auto at = places.begin(), next = at; at != places.end(); at = next) {
    next = std::find_if(at, places.end(), [&](const Place& p) { return p.compare(*at) != 0; });
    const bool beyond = is_inside(ray, solid, next != places.end() ? between(*at, *next) : after(*at));
    const auto hit = std::find_if(at, next, [](const Place& p) { return p.is_hit; });
    if (beyond != inside && hit != next) found.push_back(*hit);
    inside = beyond;
  }
  return found;
}

void sort(std::vector<Place>& places) {
  std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    const int order = a.compare(b);
    return order < 0 || (order == 0 && a.primitive < b.primitive);
  });
}

}  // namespace

ExactRay exact_ray(const Ray& ray) { return {point(ray.origin), point(ray.direction)}; }

ExactRay exact_ray(const Ray& ray, const WorldToObject& map) {
  return {times(map.linear, minus(point(ray.origin), point(map.origin))), times(map.linear, point(ray.direction))};
}

int Place::compare(const Dyadic& n, const Dyadic& d) const {
  const Dyadic num = d.sign() < 0 ? -n : n, den = d.sign() < 0 ? -d : d;
  if (!is_root) return (p * den - num * q).sign();
  // The parabola opens upwards: negative between the roots. Outside, its axis tells on which side.
  const int value = (a * num * num + (b + b) * num * den + c * den * den).sign();
  const int beside_axis = (a * num + b * den).sign();
  if (value < 0) return upper ? 1 : -1;
  if (value == 0 && (beside_axis > 0) == upper) return 0;
  return beside_axis > 0 ? -1 : 1;
}

int Place::compare(const Place& other) const {
  if (!other.is_root) return compare(other.p, other.q);
  if (!is_root) return -other.compare(p, q);
  return static_cast<int>(upper) - static_cast<int>(other.upper);
}

std::vector<Place> exact_hits(const Ray& ray, const Geometry& geometry, const Quadric& quadric) {
  const ExactRay local = exact_ray(ray, quadric.to_object);
  const Solid solid = solid_of(geometry, quadric);
  std::vector<Place> places;
  if (quadric.type == QuadricType::plane || quadric.type == QuadricType::disk) {
    const QuadricMatrix& circle = unit_matrix(QuadricType::cylinder);
    add_plane(local, 0, quadric.type == QuadricType::disk ? &circle : nullptr, 0, places);
    return places;
  }
  add_roots(local, solid, places);
  std::erase_if(places, [&](const Place& t) {
    for (int i = 0; i < 3; ++i)
      if (!within(t, local.origin[static_cast<std::size_t>(i)], local.direction[static_cast<std::size_t>(i)],
                  solid.low[i], solid.high[i]))
        return true;
    return false;
  });
  if (quadric.capped)
    for (const std::uint32_t cap : {1u, 2u}) {
      const double height = cap == 1 ? solid.low.z : solid.high.z;
      // A cap that is a point is none.
      if (product(solid.matrix, {0, 0, height}, 1, {0, 0, height}, 1).sign() < 0)
        add_plane(local, height, &solid.matrix, cap, places);
    }
  sort(places);
  if (quadric.capped) return passages(local, solid, places);
  std::erase_if(places, [](const Place& place) { return !place.is_hit; });
  return places;
}

std::vector<Place> exact_hits(const Ray& ray, const Geometry& geometry) {
  const auto [o, d] = exact_ray(ray);
  std::vector<Place> places;
  for (std::uint32_t i = 0; i < geometry.triangles.size(); ++i) {
    const glm::uvec3& index = geometry.triangles[i];
    const Point a = minus(point(geometry.vertex(index.x)), o), b = minus(point(geometry.vertex(index.y)), o),
                c = minus(point(geometry.vertex(index.z)), o);
    const Dyadic u = dot(d, cross(b, c)), v = dot(d, cross(c, a)), w = dot(d, cross(a, b));
    const bool positive = u.sign() > 0 || v.sign() > 0 || w.sign() > 0;
    const bool negative = u.sign() < 0 || v.sign() < 0 || w.sign() < 0;
    if (positive != negative) places.push_back(fraction(dot(a, cross(b, c)), u + v + w, i));
  }
  sort(places);
  return places;
}

bool is_nearest_double(double t, const Place& place) {
  const auto middle = [&](double beside) { return Dyadic(0.5) * (Dyadic(t) + Dyadic(beside)); };
  return place.compare(middle(std::nextafter(t, -infinity)), 1) >= 0 &&
         place.compare(middle(std::nextafter(t, infinity)), 1) <= 0;
}

}  // namespace rayengine::test
