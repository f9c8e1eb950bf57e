#include "render/gl_context.h"

#include <cstdlib>
#include <cstring>

#include "base/errors.h"
#include "render/gl_door.h"

namespace smokebox {

namespace {

void refuseKnownCrash() {
  const char* width = std::getenv("LP_NATIVE_VECTOR_WIDTH");
  if (width && std::strcmp(width, "512") == 0)
    throw GlError("LP_NATIVE_VECTOR_WIDTH=512 makes Mesa's llvmpipe crash: unset it, or set it to 256");
}

std::unique_ptr<GlDoor> open(GlBackend backend) {
#ifdef SMOKEBOX_HAS_OSMESA
  if (backend == GlBackend::osmesa) return openOsmesa();
#endif
#ifdef SMOKEBOX_HAS_EGL
  if (backend == GlBackend::egl) return openEgl();
#endif
  throw GlError(std::string("this build has no ") + nameOf(backend));
}

}  // namespace

GlContext::GlContext(GlBackend backend) {
  refuseKnownCrash();
  door_ = open(backend);
  makeCurrent();

#define SMOKEBOX_GL_LOAD(name, type)                              \
  gl_.name = reinterpret_cast<type>(door_->function("gl" #name)); \
  if (!gl_.name) throw GlError("this OpenGL has no function gl" #name);
  SMOKEBOX_GL_FUNCTIONS(SMOKEBOX_GL_LOAD)
#undef SMOKEBOX_GL_LOAD

  rendererName_ = reinterpret_cast<const char*>(gl_.GetString(GL_RENDERER));
  if (rendererName_.find("softpipe") != std::string::npos)
    throw GlError(
        "OpenGL would be drawn by softpipe, some 45 times slower than llvmpipe: unset GALLIUM_DRIVER, "
        "or install a Mesa with llvmpipe (libgl1-mesa-dri)");
}

GlContext::~GlContext() = default;

void GlContext::makeCurrent() { door_->makeCurrent(); }

}  // namespace smokebox
