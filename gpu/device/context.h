#pragma once

#include <memory>
#include <string>
#include <vector>

namespace rayengine {

/// Who answers the OpenGL calls of a context.
struct GpuInfo {
  std::string platform;  ///< "device 0" or "surfaceless"
  std::string vendor, renderer, version;
  bool software = false;  ///< a rasterizer on the CPU, such as llvmpipe
  int texture_size = 0;   ///< largest width and height of a texture
  int buffer_texels = 0;  ///< largest number of texels in a buffer texture
  int storage_bytes = 0;  ///< largest shader storage block
  int invocations = 0;    ///< largest compute work group
};

/// What a context knows beside what OpenGL 4.5 has kept. All here is written for the core.
enum class Profile {
  core,
  /// Older parts as well, where the device has them: points are not sprites there, unless they are asked to be. In the
  /// core all are, with coordinates within the point, for which llvmpipe sets up each like two triangles.
  compatibility,
};

/// An OpenGL 4.5 context without a window, through EGL: on a device of EGL_EXT_device_enumeration, hardware before
/// software, else surfaceless. It is current on the thread that made it, which is the only one that may use or destroy
/// it.
class Context {
 public:
  /// `device` as listed by gpu_devices(); any when negative. Throws Error that says all that was tried.
  explicit Context(int device = -1, Profile profile = Profile::core);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const GpuInfo& info() const { return info_; }

  /// Throws Error when OpenGL reported an error since the last call, or the device was reset. `during` says what was
  /// done.
  void check_errors(const char* during);

 private:
  struct Egl;
  std::unique_ptr<Egl> egl_;
  GpuInfo info_;
  std::string reported_;  ///< first complaint of OpenGL's debug output; debug builds only
};

/// What each EGL device says of itself, in the order of their numbers: a context is made on each. Empty without EGL. A
/// device that gives no context has a `renderer` that is empty, and the reason in `version`.
std::vector<GpuInfo> gpu_devices();

}  // namespace rayengine
