#pragma once

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
};

/// Names of all tracers, and one line on each for --help.
struct TracerInfo {
  std::string_view name;
  std::string_view summary;
};
std::span<const TracerInfo> tracer_list();

/// Makes a tracer by name; `auto` is the best for this machine. Throws Error on an unknown name or a precision that the
/// tracer cannot hold, naming those it can.
std::unique_ptr<Tracer> make_tracer(std::string_view name, std::shared_ptr<const Geometry> geometry,
                                    const TracerOptions& options = {});

}  // namespace rayengine
