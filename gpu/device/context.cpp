#include "gpu/device/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <utility>

#include "accel/tracer.h"
#include "gpu/device/egl_display.h"

namespace rayengine {
namespace {

#ifdef NDEBUG
constexpr bool debug = false;
#else
constexpr bool debug = true;
#endif

/// Any configuration will do, since nothing is ever drawn to a surface.
EGLConfig any_config(EGLDisplay display) {
  if (has_extension(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_no_config_context")) return EGL_NO_CONFIG_KHR;
  const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = EGL_NO_CONFIG_KHR;
  EGLint count = 0;
  eglChooseConfig(display, wanted, &config, 1, &count);
  return config;
}

EGLContext create_context(EGLDisplay display, EGLint profile_bit, bool robust) {
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK, profile_bit, EGL_CONTEXT_OPENGL_DEBUG, debug,
                               // The last pair makes a lost device known instead of undefined; drivers may refuse it.
                               robust ? EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY : EGL_NONE,
                               EGL_LOSE_CONTEXT_ON_RESET, EGL_NONE};
  return eglCreateContext(display, any_config(display), EGL_NO_CONTEXT, attributes);
}

/// The first that the driver agrees to.
EGLContext create_context(EGLDisplay display, Profile profile) {
  EGLContext context = EGL_NO_CONTEXT;
  for (const EGLint bit : {EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT}) {
    if (bit == EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT && profile == Profile::core) continue;
    for (const bool robust : {true, false})
      if (context == EGL_NO_CONTEXT) context = create_context(display, bit, robust);
  }
  return context;
}

std::string text(GLenum name) {
  const GLubyte* s = glGetString(name);
  return s ? reinterpret_cast<const char*>(s) : "";
}

int integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

GpuInfo describe(const EglCandidate& candidate) {
  GpuInfo info{candidate.name, text(GL_VENDOR), text(GL_RENDERER), text(GL_VERSION)};
  info.software = candidate.software || info.renderer.find("llvmpipe") != std::string::npos ||
                  info.renderer.find("softpipe") != std::string::npos;
  info.texture_size = integer(GL_MAX_TEXTURE_SIZE);
  info.buffer_texels = integer(GL_MAX_TEXTURE_BUFFER_SIZE);
  info.storage_bytes = integer(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
  info.invocations = integer(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
  return info;
}

const char* error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM: return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE: return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION: return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION: return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY: return "GL_OUT_OF_MEMORY";
    case GL_CONTEXT_LOST: return "GL_CONTEXT_LOST";
    default: return "an unknown error";
  }
}

void GLAPIENTRY keep_complaint(GLenum, GLenum type, GLuint, GLenum, GLsizei length, const GLchar* message,
                               const void* user) {
  auto& kept = *static_cast<std::string*>(const_cast<void*>(user));
  const bool wrong = type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR;
  if (wrong && kept.empty()) kept.assign(message, static_cast<std::size_t>(length));
}

}  // namespace

struct Context::Egl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;

  Egl() = default;
  Egl(const Egl&) = delete;
  ~Egl() {
    if (context == EGL_NO_CONTEXT) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
  }

  /// Returns what went wrong, or nothing.
  std::string open(const EglCandidate& candidate, Profile profile) {
    display = eglGetPlatformDisplayEXT(candidate.platform, candidate.native, nullptr);
    if (display == EGL_NO_DISPLAY) return "no display, " + egl_error();
    if (!eglInitialize(display, nullptr, nullptr)) return "cannot be initialised, " + egl_error();
    if (!eglBindAPI(EGL_OPENGL_API)) return "has no OpenGL, " + egl_error();
    context = create_context(display, profile);
    if (context == EGL_NO_CONTEXT) return "no OpenGL 4.5 core context, " + egl_error();
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
      return "no context without a surface, " + egl_error();
    if (epoxy_gl_version() < 45) return "OpenGL is only " + text(GL_VERSION);
    return {};
  }
};

Context::Context(int device, Profile profile) {
  std::string tried;
  for (const EglCandidate& candidate : egl_candidates(device)) {
    egl_ = std::make_unique<Egl>();
    const std::string failure = egl_->open(candidate, profile);
    if (failure.empty()) {
      info_ = describe(candidate);
      break;
    }
    tried += (tried.empty() ? "" : "; ") + candidate.name + ": " + failure;
    egl_.reset();
  }
  if (!egl_)
    throw Error("no GPU with OpenGL 4.5: tried " + (tried.empty() ? "EGL, which has no device" : tried) +
                "; use --tracer embree");
  if (debug) {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(keep_complaint, &reported_);
  }
}

Context::~Context() = default;

void Context::check_errors(const char* during) {
  // Without its context the thread's calls do nothing, and report nothing.
  const bool lost = eglGetCurrentContext() != egl_->context || glGetGraphicsResetStatus() != GL_NO_ERROR;
  const GLenum error = lost ? GLenum{GL_CONTEXT_LOST} : glGetError();
  while (!lost && glGetError() != GL_NO_ERROR) {
  }
  if (error == GL_NO_ERROR && reported_.empty()) return;
  const std::string detail = reported_.empty() ? "" : ": " + std::exchange(reported_, {});
  throw Error(std::string("the GPU (") + info_.renderer + ") failed during " + during + ": " + error_name(error) +
              detail + "; use --tracer embree");
}

std::vector<GpuInfo> gpu_devices() {
  std::vector<GpuInfo> result;
  for (const EglCandidate& candidate : egl_devices()) {
    try {
      result.push_back(Context(static_cast<int>(result.size())).info());
    } catch (const Error& error) {
      result.push_back({candidate.name, "", "", error.what()});
    }
  }
  return result;
}

}  // namespace rayengine
