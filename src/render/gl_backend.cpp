#include "render/gl_backend.h"

#include <cstdlib>

#include "base/errors.h"

namespace smokebox {

std::vector<GlBackend> builtGlBackends() {
  return {
#ifdef SMOKEBOX_HAS_OSMESA
      GlBackend::osmesa,
#endif
#ifdef SMOKEBOX_HAS_EGL
      GlBackend::egl,
#endif
  };
}

GlBackend defaultGlBackend() { return builtGlBackends().front(); }

const char* nameOf(GlBackend backend) { return backend == GlBackend::osmesa ? "osmesa" : "egl"; }

GlBackend glBackendNamed(const std::string& name) {
  if (name.empty()) return defaultGlBackend();
  std::string built;
  for (const GlBackend backend : builtGlBackends()) {
    if (name == nameOf(backend)) return backend;
    built += (built.empty() ? "" : " and ") + std::string(nameOf(backend));
  }
  throw UsageError("--gl: this build has no '" + name + "'; it has " + built);
}

void preferDrawingAlone() {
  ::setenv("LP_NUM_THREADS", "0", 0);
  ::setenv("LIBGL_ALWAYS_SOFTWARE", "true", 0);
}

}  // namespace smokebox
