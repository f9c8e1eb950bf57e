#include "render/gl_context.h"

#include <GL/osmesa.h>

#include <array>
#include <cstdlib>
#include <cstring>

#include "base/errors.h"

namespace smokebox {

struct GlContext::Handle {
  struct Destroy {
    void operator()(OSMesaContext context) const { OSMesaDestroyContext(context); }
  };
  std::unique_ptr<std::remove_pointer_t<OSMesaContext>, Destroy> context;
  // OSMesa insists on a window buffer, which is never drawn to: pictures go to a framebuffer object.
  static constexpr int kWindow = 16;
  std::array<unsigned char, 4 * kWindow * kWindow> window{};
};

namespace {
void refuseKnownCrash() {
  const char* width = std::getenv("LP_NATIVE_VECTOR_WIDTH");
  if (width && std::strcmp(width, "512") == 0)
    throw GlError("LP_NATIVE_VECTOR_WIDTH=512 makes Mesa's llvmpipe crash: unset it, or set it to 256");
}
}  // namespace

GlContext::GlContext() : handle_(std::make_unique<Handle>()) {
  refuseKnownCrash();
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            3,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            3,
                            0};
  handle_->context.reset(OSMesaCreateContextAttribs(attributes, nullptr));
  if (!handle_->context)
    throw GlError("OSMesa gives no OpenGL 3.3 core context (is libosmesa6 8 or newer installed?)");
  makeCurrent();

#define SMOKEBOX_GL_LOAD(name, type)                                   \
  gl_.name = reinterpret_cast<type>(OSMesaGetProcAddress("gl" #name)); \
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

void GlContext::makeCurrent() {
  if (OSMesaGetCurrentContext() == handle_->context.get()) return;
  if (!OSMesaMakeCurrent(handle_->context.get(), handle_->window.data(), GL_UNSIGNED_BYTE, Handle::kWindow,
                         Handle::kWindow))
    throw GlError("OSMesa cannot make its context current");
}

}  // namespace smokebox
