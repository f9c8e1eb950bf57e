// OpenGL through EGL without a surface and without a display (EGL_MESA_platform_surfaceless,
// EGL_KHR_surfaceless_context): pictures go to a framebuffer object. That Mesa draws by software is said in
// the environment, see preferDrawingAlone().
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <string>
#include <string_view>

#include "base/errors.h"
#include "render/gl_door.h"

namespace smokebox {

namespace {

[[noreturn]] void fail(const std::string& what) {
  char code[32];
  std::snprintf(code, sizeof code, " (EGL's error 0x%x)", static_cast<unsigned>(eglGetError()));
  throw GlError(what + code);
}

bool hasExtension(EGLDisplay display, std::string_view name) {
  const char* all = eglQueryString(display, EGL_EXTENSIONS);
  const std::string_view list = all ? all : "";
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find(' ', begin), list.size());
    if (list.substr(begin, end - begin) == name) return true;
    begin = end + 1;
  }
  return false;
}

/// EGL has one display of a platform in a process, whoever asks for it, and terminating it ends the contexts
/// of all: so those who use it are counted, and the last one closes it.
class Display {
 public:
  Display() {
    const std::lock_guard lock(users().mutex);
    if (!hasExtension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
      throw GlError(
          "this EGL cannot do without a display: it lacks EGL_MESA_platform_surfaceless (is libegl-mesa0 "
          "installed?)");
    display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY) fail("EGL gives no display without a surface");
    // Again and again is allowed, and does nothing.
    if (!eglInitialize(display_, nullptr, nullptr))
      fail("EGL cannot be started (is libgl1-mesa-dri installed?)");
    ++users().count;
  }
  ~Display() {
    const std::lock_guard lock(users().mutex);
    if (--users().count > 0) return;
#ifndef __SANITIZE_ADDRESS__
    eglTerminate(display_);  // unloads Mesa's driver; what that still held would be reported as a leak
#endif
  }
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  EGLDisplay get() const { return display_; }

 private:
  struct Users {
    std::mutex mutex;
    int count = 0;
  };
  static Users& users() {
    static Users all;
    return all;
  }
  EGLDisplay display_ = EGL_NO_DISPLAY;
};

class EglDoor : public GlDoor {
 public:
  EglDoor() {
    if (!hasExtension(display_.get(), "EGL_KHR_surfaceless_context"))
      throw GlError("this EGL cannot draw without a surface: it lacks EGL_KHR_surfaceless_context");
    bindApi();
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 3,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 3,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
    context_ = eglCreateContext(display_.get(), config(), EGL_NO_CONTEXT, attributes);
    if (context_ == EGL_NO_CONTEXT) fail("EGL gives no OpenGL 3.3 core context");
  }
  ~EglDoor() override {
    // A context that is current lives on; so it is let go first.
    if (eglBindAPI(EGL_OPENGL_API) && eglGetCurrentContext() == context_) letGo();
    eglDestroyContext(display_.get(), context_);
  }

  /// Let go and taken again even if EGL believes that the thread has it: a context of OSMesa may have come in
  /// between, of which EGL knows nothing. Once a picture, that costs nothing.
  void makeCurrent() override {
    bindApi();
    if (!letGo() || !eglMakeCurrent(display_.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      fail("EGL cannot make its context current");
  }

  Function function(const char* name) const override { return eglGetProcAddress(name); }

 private:
  /// The kind of context that calls are about is a matter of the thread.
  static void bindApi() {
    if (!eglBindAPI(EGL_OPENGL_API)) fail("this EGL has no OpenGL, only OpenGL ES");
  }
  bool letGo() const {
    return eglMakeCurrent(display_.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  EGLConfig config() const {
    if (hasExtension(display_.get(), "EGL_KHR_no_config_context")) return EGL_NO_CONFIG_KHR;
    const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display_.get(), wanted, &config, 1, &count) || count < 1)
      fail("EGL has no configuration for OpenGL");
    return config;
  }

  Display display_;  // first: the context lives in it
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<GlDoor> openEgl() { return std::make_unique<EglDoor>(); }

}  // namespace smokebox
