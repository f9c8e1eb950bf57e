// OpenGL through OSMesa: Mesa's llvmpipe, which draws on the CPU, without any window system.
#include <GL/osmesa.h>

#include <array>
#include <type_traits>

#include "base/errors.h"
#include "render/gl_door.h"

#ifdef __SANITIZE_ADDRESS__
/// OSMesa loses a few hundred bytes with every context: none of ours.
extern "C" const char* __lsan_default_suppressions() { return "leak:libOSMesa\n"; }
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
#endif

namespace smokebox {

namespace {

class OsmesaDoor : public GlDoor {
 public:
  OsmesaDoor() {
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              3,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              3,
                              0};
    context_.reset(OSMesaCreateContextAttribs(attributes, nullptr));
    if (!context_)
      throw GlError("OSMesa gives no OpenGL 3.3 core context (is libosmesa6 8 or newer installed?)");
  }

  void makeCurrent() override {
    if (OSMesaGetCurrentContext() == context_.get()) return;
    if (!OSMesaMakeCurrent(context_.get(), window_.data(), GL_UNSIGNED_BYTE, kWindow, kWindow))
      throw GlError("OSMesa cannot make its context current");
  }

  Function function(const char* name) const override { return OSMesaGetProcAddress(name); }

 private:
  struct Destroy {
    void operator()(OSMesaContext context) const { OSMesaDestroyContext(context); }
  };
  // OSMesa insists on a window buffer, which is never drawn to: pictures go to a framebuffer object.
  static constexpr int kWindow = 16;
  std::array<unsigned char, 4 * kWindow * kWindow> window_{};
  std::unique_ptr<std::remove_pointer_t<OSMesaContext>, Destroy> context_;
};

}  // namespace

std::unique_ptr<GlDoor> openOsmesa() { return std::make_unique<OsmesaDoor>(); }

}  // namespace smokebox
