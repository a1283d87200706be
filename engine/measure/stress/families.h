#pragma once

#include "engine/measure/stress/case.h"

// What the families make; see families.cpp for what each is about.
namespace rayengine::stability {

using Cases = std::vector<Case>;

// far.cpp
Cases far_cases(std::size_t rays, std::uint64_t seed);
Cases planet_cases(std::size_t rays, std::uint64_t seed);
Cases small_and_far_cases(std::size_t rays, std::uint64_t seed);
Cases scale_cases(std::size_t rays, std::uint64_t seed);
Cases offset_cases(std::size_t rays, std::uint64_t seed);
// tangent.cpp
Cases tangent_cases(std::size_t rays, std::uint64_t seed);
// cone.cpp
Cases generator_cases(std::size_t rays, std::uint64_t seed);
Cases apex_cases(std::size_t rays, std::uint64_t seed);
Cases nappe_cases(std::size_t rays, std::uint64_t seed);
Cases tiny_end_cases(std::size_t rays, std::uint64_t seed);
// cylinder.cpp
Cases near_axis_cases(std::size_t rays, std::uint64_t seed);
Cases along_axis_cases(std::size_t rays, std::uint64_t seed);
Cases long_body_cases(std::size_t rays, std::uint64_t seed);
Cases tilted_axis_cases(std::size_t rays, std::uint64_t seed);
// surface.cpp
Cases leaving_cases(std::size_t rays, std::uint64_t seed);
Cases nested_cases(std::size_t rays, std::uint64_t seed);
// form.cpp
Cases degenerate_cases(std::size_t rays, std::uint64_t seed);
Cases asymptote_cases(std::size_t rays, std::uint64_t seed);
Cases ruling_cases(std::size_t rays, std::uint64_t seed);
Cases stretched_cases(std::size_t rays, std::uint64_t seed);
Cases rim_cases(std::size_t rays, std::uint64_t seed);
// mesh.cpp
Cases fan_cases(std::size_t rays, std::uint64_t seed);
Cases diagonal_cases(std::size_t rays, std::uint64_t seed);
Cases closed_mesh_cases(std::size_t rays, std::uint64_t seed);
Cases sliver_cases(std::size_t rays, std::uint64_t seed);
// triangle.cpp
Cases tiny_triangle_cases(std::size_t rays, std::uint64_t seed);
Cases grazing_cases(std::size_t rays, std::uint64_t seed);
Cases coplanar_cases(std::size_t rays, std::uint64_t seed);
Cases slab_cases(std::size_t rays, std::uint64_t seed);
// input.cpp
Cases bad_input_cases(std::size_t rays, std::uint64_t seed);
Cases interval_cases(std::size_t rays, std::uint64_t seed);
// queries.cpp
Cases parity_cases(std::size_t rays, std::uint64_t seed);
Cases agreement_cases(std::size_t rays, std::uint64_t seed);
// metamorphic.cpp
Cases metamorphic_cases(std::size_t rays, std::uint64_t seed);

}  // namespace rayengine::stability
