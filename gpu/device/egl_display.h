#pragma once

#include <epoxy/egl.h>

#include <string>
#include <vector>

namespace rayengine {

/// A display on which to try for a context. EGL shares displays within a process, so they are never terminated: another
/// context may stand on them.
struct EglCandidate {
  EGLenum platform;
  void* native;
  std::string name;
  bool software = false;
};

/// Devices in the order of their numbers, empty where EGL cannot list them.
std::vector<EglCandidate> egl_devices();

/// What to try in turn for device `number`; when negative hardware, then software, then surfaceless. Throws Error when
/// there is no EGL or no such device.
std::vector<EglCandidate> egl_candidates(int number);

/// The name of the last EGL error on this thread, such as "EGL_BAD_MATCH".
std::string egl_error();

/// Whether a space-separated list holds a name.
bool has_extension(const char* list, const std::string& name);

}  // namespace rayengine
