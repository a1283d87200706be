#include "gpu/device/hardware.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "accel/tracer.h"
#include "gpu/device/egl_display.h"

namespace rayengine {

bool may_have_gpu() {
  // Direct rendering; NVIDIA's own driver; Windows' GPU under Linux; Adreno and Mali.
  constexpr std::array nodes = {"/dev/dri/renderD128", "/dev/nvidiactl", "/dev/dxg", "/dev/kgsl-3d0", "/dev/mali0"};
  std::error_code none;
  return std::ranges::any_of(nodes, [&](const char* node) { return std::filesystem::exists(node, none); });
}

void require_hardware(int device) {
  const std::vector<EglCandidate> candidates = egl_candidates(device);
  if (candidates.empty() || candidates.front().software)
    throw Error("EGL has at most a renderer in software, which cannot pay");
}

}  // namespace rayengine
