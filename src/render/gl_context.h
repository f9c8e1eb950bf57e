// The one door to OpenGL: an off-screen 3.3 core context without a display, drawn on the CPU by Mesa's
// llvmpipe. Behind it stands OSMesa, or EGL without a surface: one file each (gl_osmesa.cpp, gl_egl.cpp),
// built if its library is there. Any number of contexts may live at once, each in a thread of its own.
#pragma once
#include <memory>
#include <string>

#include "render/gl.h"
#include "render/gl_backend.h"

namespace smokebox {

class GlDoor;

class GlContext {
 public:
  /// Makes a context and takes it for the calling thread. Throws GlError: no context, a missing function, or
  /// the softpipe rasteriser, which is some 45 times slower.
  explicit GlContext(GlBackend backend = defaultGlBackend());
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Takes the context for the calling thread (again).
  void makeCurrent();
  const Gl& gl() const { return gl_; }
  /// What draws, in the driver's own words.
  const std::string& rendererName() const { return rendererName_; }

 private:
  std::unique_ptr<GlDoor> door_;
  Gl gl_;
  std::string rendererName_;
};

}  // namespace smokebox
