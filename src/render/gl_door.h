// What a backend must bring: a context, and a way to its functions. One implementation a file; only
// GlContext calls them.
#pragma once
#include <memory>

namespace smokebox {

class GlDoor {
 public:
  using Function = void (*)();

  virtual ~GlDoor() = default;
  /// Takes the context for the calling thread, whatever that had before. Throws GlError.
  virtual void makeCurrent() = 0;
  /// Null if there is no such function.
  virtual Function function(const char* name) const = 0;
};

// Both make an OpenGL 3.3 core context; they throw GlError. Defined only if the backend is built.
std::unique_ptr<GlDoor> openOsmesa();
std::unique_ptr<GlDoor> openEgl();

}  // namespace smokebox
