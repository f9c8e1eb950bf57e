// Names of backends in what googletest prints.
#pragma once
#include <ostream>

#include "render/gl_backend.h"

namespace smokebox {

inline void PrintTo(GlBackend backend, std::ostream* out) { *out << nameOf(backend); }

}  // namespace smokebox
