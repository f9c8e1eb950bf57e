// Draws a Snapshot into an Image, off-screen.
#pragma once
#include <memory>

#include "image/image.h"
#include "render/gl_backend.h"
#include "world/snapshot.h"

namespace smokebox {

class Renderer {
 public:
  /// Takes the OpenGL context for the calling thread; draw() must be called there. Throws GlError.
  Renderer(int width, int height, GlBackend backend = defaultGlBackend());
  ~Renderer();

  /// `image` is resized as needed.
  void draw(const Snapshot& snapshot, Image& image);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace smokebox
