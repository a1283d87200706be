#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "accel/tracer.h"

namespace rayengine {

/// What one kind of primitive costs a tracer. Times are for the whole machine: all its threads together.
struct PrimitiveCost {
  double build = 0;                               ///< seconds a primitive
  double bytes = 0;                               ///< a primitive
  std::array<double, 3> counts{};                 ///< primitives among which rays were measured: few, some and many
  std::array<double, 3> coherent{}, scattered{};  ///< seconds a ray among so many
};

struct TracerCost {
  std::string tracer;
  Precision precision = Precision::robust;
  Build build = Build::thorough;
  std::uint32_t treelet = 0;  ///< primitives that a treelet holds at most; of stream, 0 elsewhere
  double start = 0;           ///< seconds before anything is built: a context, and kernels to compile
  double triangle_roundoff = 0, quadric_roundoff = 0;  ///< as in Limits
  PrimitiveCost triangle, quadric, instance;           ///< instances of something small
};

std::string_view to_string(Build build);

/// Seconds a ray among so many primitives, between those that were measured and beyond: by doublings of their number
/// or, without a structure, by their number. Fewer than were measured take as long as the fewest.
double per_ray(const PrimitiveCost& cost, Build build, bool coherent, double primitives);

/// What was measured of a machine, for plans to choose by.
struct DeviceMeasurements {
  std::vector<TracerCost> tracers;
  double recognise_whole = 0;  ///< seconds a triangle, looking for quadrics in whole pieces of a mesh
  double recognise_parts = 0;  ///< and in their parts
  double simplify = 0;         ///< seconds a triangle of a mesh that is made coarser
};

/// What measure_device() found on the machine of docs/performance.md: ratios that hold well enough elsewhere.
const DeviceMeasurements& usual_device();

/// A text file of one line each, which load_device() reads again.
std::string to_text(const DeviceMeasurements& device);
/// Throws Error on anything else than to_text() writes.
DeviceMeasurements device_from_text(const std::string& text);

}  // namespace rayengine
