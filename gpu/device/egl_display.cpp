#include "gpu/device/egl_display.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "accel/tracer.h"

namespace rayengine {
namespace {

bool is_software(EGLDeviceEXT device) {
  return has_extension(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
}

const char* client_extensions() { return eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS); }

}  // namespace

bool has_extension(const char* list, const std::string& name) {
  std::istringstream words(list ? list : "");
  for (std::string word; words >> word;)
    if (word == name) return true;
  return false;
}

std::string egl_error() {
  constexpr std::array names{"EGL_SUCCESS",       "EGL_NOT_INITIALIZED",     "EGL_BAD_ACCESS",
                             "EGL_BAD_ALLOC",     "EGL_BAD_ATTRIBUTE",       "EGL_BAD_CONFIG",
                             "EGL_BAD_CONTEXT",   "EGL_BAD_CURRENT_SURFACE", "EGL_BAD_DISPLAY",
                             "EGL_BAD_MATCH",     "EGL_BAD_NATIVE_PIXMAP",   "EGL_BAD_NATIVE_WINDOW",
                             "EGL_BAD_PARAMETER", "EGL_BAD_SURFACE",         "EGL_CONTEXT_LOST"};
  const auto index = static_cast<std::size_t>(eglGetError() - EGL_SUCCESS);
  return index < names.size() ? names[index] : "an unknown EGL error";
}

std::vector<EglCandidate> egl_devices() {
  if (!epoxy_has_egl() || !has_extension(client_extensions(), "EGL_EXT_device_enumeration") ||
      !has_extension(client_extensions(), "EGL_EXT_platform_device"))
    return {};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(0, nullptr, &count)) return {};
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  eglQueryDevicesEXT(count, devices.data(), &count);
  std::vector<EglCandidate> result;
  for (EGLDeviceEXT device : devices)
    result.push_back({EGL_PLATFORM_DEVICE_EXT, device, "device " + std::to_string(result.size()), is_software(device)});
  return result;
}

std::vector<EglCandidate> egl_candidates(int number) {
  if (!epoxy_has_egl()) throw Error("no GPU: libEGL.so.1 is not installed; install it or use --tracer embree");
  std::vector<EglCandidate> devices = egl_devices();
  if (number >= static_cast<int>(devices.size()))
    throw Error("no GPU " + std::to_string(number) + ": EGL lists " + std::to_string(devices.size()) +
                " devices, numbered from 0; see rayengine info");
  if (number >= 0) return {devices[static_cast<std::size_t>(number)]};
  std::stable_partition(devices.begin(), devices.end(), [](const EglCandidate& c) { return !c.software; });
  if (has_extension(client_extensions(), "EGL_MESA_platform_surfaceless"))
    devices.push_back({EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, "surfaceless", false});
  return devices;
}

}  // namespace rayengine
