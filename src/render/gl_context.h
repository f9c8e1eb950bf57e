// The one door to OpenGL: an off-screen 3.3 core context without a display. Behind it stands OSMesa (Mesa's
// llvmpipe, which draws on the CPU); another way in, such as EGL without a surface, would be a second
// constructor of the same class.
#pragma once
#include <memory>
#include <string>

#include "render/gl.h"

namespace smokebox {

class GlContext {
 public:
  /// Makes a context and takes it for the calling thread. Throws GlError: no context, a missing function, or
  /// the softpipe rasteriser, which is some 45 times slower.
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Takes the context for the calling thread (again).
  void makeCurrent();
  const Gl& gl() const { return gl_; }
  /// What draws, in the driver's own words.
  const std::string& rendererName() const { return rendererName_; }

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
  Gl gl_;
  std::string rendererName_;
};

}  // namespace smokebox
