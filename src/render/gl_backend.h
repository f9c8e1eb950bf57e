// Which of the ways to OpenGL this program was built with. No header of OpenGL is needed to ask.
#pragma once
#include <string>
#include <vector>

namespace smokebox {

/// osmesa: Mesa's off-screen library (gone since Mesa 25.1). egl: EGL without a surface or a display.
enum class GlBackend { osmesa, egl };

/// Best first; never empty.
std::vector<GlBackend> builtGlBackends();
/// The first of them.
GlBackend defaultGlBackend();

/// "osmesa", "egl".
const char* nameOf(GlBackend backend);
/// The default for an empty name. Throws UsageError for one that is not built, or not known.
GlBackend glBackendNamed(const std::string& name);

/// Says in the environment how Mesa should draw, where the user has not said it: by software, and on the
/// drawing thread itself (there is too little to draw for it to be worth waking llvmpipe's threads, which
/// would take the cores from the simulation). To be called while the process has one thread.
void preferDrawingAlone();

}  // namespace smokebox
