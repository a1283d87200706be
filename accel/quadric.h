#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "accel/box.h"
#include "accel/transform.h"

namespace rayengine {

enum class QuadricType : std::uint8_t {
  sphere,
  cylinder,
  cone,
  paraboloid,
  hyperboloid1,
  hyperboloid2,
  saddle,
  plane,
  disk,
  general,
};
inline constexpr std::size_t quadric_type_count = 10;

std::string_view to_string(QuadricType type);
std::optional<QuadricType> parse_quadric_type(std::string_view name);

/// The upper triangle A..J of the symmetric matrix Q = [[A,B,C,D],[B,E,F,G],[C,F,H,I],[D,G,I,J]]; the surface is x^T Q
/// x = 0.
using QuadricMatrix = std::array<double, 10>;

/// The matrix of a unit primitive. `general` has none and gives zeros.
const QuadricMatrix& unit_matrix(QuadricType type);

/// What a caller says of a quadric in its object space; what is left out takes the type's default.
struct QuadricShape {
  QuadricType type = QuadricType::sphere;
  bool capped = false;
  std::optional<std::array<double, 2>> clip;  ///< range of z
  std::optional<QuadricMatrix> matrix;        ///< `general` only, and needed there
  std::optional<Box> box;                     ///< clips x, y and z
};

/// A quadric ready for intersection: rays are taken to object space, where the unit primitive stands.
struct Quadric {
  WorldToObject to_object;
  double zmin = -infinity, zmax = infinity;  ///< clip planes in object space
  std::uint32_t object = no_id;              ///< the object that it is
  std::uint32_t form = no_id;                ///< index into Geometry::forms, for `general`
  QuadricType type = QuadricType::sphere;
  bool capped = false;
};
static_assert(sizeof(Quadric) <= 128);

/// What a `general` quadric needs beyond Quadric.
struct GeneralForm {
  QuadricMatrix matrix{};
  Box box;  ///< object space; sides may be infinite
};

/// Primitive ids that a quadric takes: its side, and when capped its lower and upper cap.
inline std::uint32_t primitive_count(const Quadric& q) { return q.capped ? 3 : 1; }

/// Whether it is a whole sphere under one scale for all axes, without any turning.
bool is_ball(const Quadric& quadric);

/// What kernels need of the quadrics of one type.
struct QuadricTraits {
  bool any = false;
  bool clipped = false;  ///< by planes across z, be it only one of them
  bool capped = false;
  bool balls = true;  ///< all of them are is_ball()
};
using TraitsByType = std::array<QuadricTraits, quadric_type_count>;

/// Adds what these need to what others do.
void add_traits(TraitsByType& traits, std::span<const Quadric> quadrics);
void add_traits(TraitsByType& traits, const TraitsByType& others);

/// World-space bounds of the clipped surface; infinite where it is. `form` is needed for `general` alone.
Box bounds(const Quadric& quadric, const GeneralForm* form);

}  // namespace rayengine
