#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

struct TracerOptions {
  Precision precision = Precision::robust;
  int threads = 0;  ///< 0: as many as the machine has
  int gpu = -1;     ///< an EGL device by its number; the best when negative
  /// Told, in one line each and from any thread, what became of the GPU where a tracer can do without.
  std::function<void(const std::string&)> say;
  /// Of embree's structure, thorough or quick, and of that of bvh at `robust`, thorough or none. Others are built in
  /// one way.
  Build build = Build::thorough;
  std::uint32_t treelet = 0;  ///< primitives that one of stream's treelets holds at most; 0 for what suits the device
};

/// Names of all tracers, and one line on each for --help.
struct TracerInfo {
  std::string_view name;
  std::string_view summary;
};
std::span<const TracerInfo> tracer_list();

/// Makes a tracer by name; `auto` is `embree`, or `hybrid` where there is a GPU that is more than software: one that is
/// looked for, and tried, when there is enough work to repay that; for `certified` it is `bvh`. Every tracer holds
/// `certified`: what it finds is proven by `bvh` (see engine/certify.h). Throws Error on an unknown name or a precision
/// that the tracer cannot hold, naming those it can.
std::unique_ptr<Tracer> make_tracer(std::string_view name, std::shared_ptr<const Geometry> geometry,
                                    const TracerOptions& options = {});

}  // namespace rayengine
