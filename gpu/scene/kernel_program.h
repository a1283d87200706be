#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gpu/device/program.h"
#include "gpu/scene/scene_textures.h"

namespace rayengine {

/// Texture units and uniform locations that the kernels in gpu/shaders/stream share.
enum KernelUnit : GLuint { entries_unit = 3, hits_unit = 4, ranges_unit = 5 };
enum KernelLocation : GLint { round_location = 1, type_location = 2, types_location = 3, object_range_location = 4 };

/// The call, as GLSL, that tests the primitive of this type whose texels begin at `index`.
std::string test_call(KernelType type, const std::string& index);
/// The call that gives its normal, of unit length, at `position`, on the part that has `rank`.
std::string normal_call(KernelType type, const std::string& index, const std::string& position,
                        const std::string& rank);
/// What gpu/shaders/grid/intersect.glsl wants defined: the tests of all types that the scene has, in the order of the
/// ranges of its lists.
std::string grid_tests(const std::vector<KernelType>& types);
/// The same of their normals, for gpu/shaders/grid/shade.glsl.
std::string grid_normals(const std::vector<KernelType>& types);

/// The name of a type, for messages.
std::string_view kernel_name(KernelType type);

/// The intersection shader for one type of primitive, over the shared kernel source. `ray_sources` say how rays and
/// hits are read and written: begin(), consider(), enough() and end().
Stage kernel_stage(KernelType type, const std::vector<std::string_view>& ray_sources, std::vector<std::string> defines);

/// The same, drawn over every texel of the viewport.
Program make_kernel_program(KernelType type, const std::vector<std::string_view>& ray_sources,
                            std::vector<std::string> defines);

}  // namespace rayengine
