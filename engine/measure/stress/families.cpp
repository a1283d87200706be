#include "engine/measure/stress/families.h"

#include <array>

namespace rayengine::stability {

std::span<const Family> families() {
  static constexpr std::array all{
      Family{1, "far", "from a distance D of 10 to 1e7 sizes, at random", far_cases},
      Family{2, "tangent", "up to 64 ulps beside a tangent, which itself is a miss", tangent_cases},
      Family{3, "planet", "2 units above a body of 6,371,000", planet_cases},
      Family{4, "small and far", "a body of 0.1 and less, passed at 0.95 of its radius", small_and_far_cases},
      Family{5, "scale", "everything times 1e-30 to 1e30", scale_cases},
      Family{6, "cone's generator", "within 1e-3 to 6e-8 of a direction that meets the cone once", generator_cases},
      Family{7, "cone's apex", "aimed at it: exact arithmetic decides", apex_cases},
      Family{8, "wrong nappe", "past a part of the surface that the clip takes away", nappe_cases},
      Family{9, "near the axis", "from inside, tilted by 0.1 to 1e-6 from the axis", near_axis_cases},
      Family{10, "along the axis", "parallel to it inside, outside and on the wall", along_axis_cases},
      Family{11, "long body", "1e3 to 1e5 long, hit from beside", long_body_cases},
      Family{12, "tilted axis", "parallel to a tilted cylinder", tilted_axis_cases},
      Family{13, "leaving", "from a point of the surface, as it is rounded and as a renderer starts", leaving_cases},
      Family{14, "degenerate form", "forms that are planes, lines, points or nothing", degenerate_cases},
      Family{15, "shared edges", "at the edges and the vertex of a fan", fan_cases},
      Family{16, "quad's diagonal", "at the edge that two triangles of a quad share", diagonal_cases},
      Family{17, "closed mesh", "from inside at edges, vertices and faces, near and far from the origin",
             closed_mesh_cases},
      Family{18, "slivers", "closed meshes of needles, with triangles without area", sliver_cases},
      Family{19, "tiny triangle", "of size 2e-4 to 1e-23", tiny_triangle_cases},
      Family{20, "grazing", "at triangles of half a degree, and at a hundredth of one", grazing_cases},
      Family{21, "coplanar", "within a triangle's plane: a miss", coplanar_cases},
      Family{22, "large coordinates", "around bodies 1e4 to 6e6 from the origin", offset_cases},
      Family{23, "coincident", "equal surfaces, and nested ones 4e-5 to 1e-14 apart", nested_cases},
      Family{24, "slabs", "with zeros of either sign, in the planes of boxes", slab_cases},
      Family{25, "bad input", "NaN, infinity, denormals, no direction, reversed intervals", bad_input_cases},
      Family{26, "interval ends", "a hit exactly at tmin, at tmax, and an ulp beside", interval_cases},
      Family{27, "all hits", "lists of all hits through closed bodies", parity_cases},
      Family{28, "agreement", "the same scene by every kind of query", agreement_cases},
      Family{29, "metamorphic", "moved, mirrored and scaled: held against the same tracer", metamorphic_cases},
      Family{30, "asymptotes", "nearly along the asymptotic cone of hyperboloids", asymptote_cases},
      Family{31, "rulings", "along and beside the lines in saddles, hyperboloids and cylinders", ruling_cases},
      Family{32, "tiny ends", "frusta that end in a circle of 1e-3 to 1e-12", tiny_end_cases},
      Family{33, "stretched", "bodies scaled by up to 1e6 along one axis", stretched_cases},
      Family{34, "rims and silhouettes", "at rims, clip planes and outlines as near as doubles come", rim_cases},
  };
  return all;
}

}  // namespace rayengine::stability
