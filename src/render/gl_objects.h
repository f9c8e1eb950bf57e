// OpenGL objects that own their handles: programs, textures, instance buffers, the framebuffer.
#pragma once
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "render/gl.h"

namespace smokebox {

/// The text of a file of shaders/, built into the program; #include "name" lines are resolved. Throws
/// GlError.
std::string shaderSource(std::string_view name);

/// A linked pair of shaders, by the names of their files.
class GlProgram {
 public:
  /// `defines`: lines that are put below #version.
  GlProgram(const Gl& gl, std::string_view vertexFile, std::string_view fragmentFile,
            const std::string& defines = "");
  ~GlProgram();
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;

  void use() const { gl_.UseProgram(program_); }
  // The program must be in use. A uniform that the compiler found unused is quietly left out by OpenGL
  // itself.
  void set(const char* name, int value) const { gl_.Uniform1i(location(name), value); }
  void set(const char* name, float value) const { gl_.Uniform1f(location(name), value); }
  void set(const char* name, float x, float y) const { gl_.Uniform2f(location(name), x, y); }
  void set(const char* name, const std::array<float, 4>& v) const {
    gl_.Uniform4f(location(name), v[0], v[1], v[2], v[3]);
  }
  void setVec3s(const char* name, const float* values, int count) const {
    gl_.Uniform3fv(location(name), count, values);
  }

 private:
  GLint location(const char* name) const { return gl_.GetUniformLocation(program_, name); }
  const Gl& gl_;
  GLuint program_ = 0;
};

/// A texture without mipmaps, clamped at its edges, that keeps its storage between frames.
class GlTexture {
 public:
  GlTexture(const Gl& gl, GLenum internalFormat, GLenum format, GLenum type, GLenum filter);
  ~GlTexture();
  GlTexture(const GlTexture&) = delete;
  GlTexture& operator=(const GlTexture&) = delete;

  void bind(int unit) const;
  /// Makes room for at least width x height texels; contents are lost if it grows.
  void reserve(int width, int height);
  /// Fills the corner at (0, 0).
  void upload(int width, int height, const void* texels);
  int width() const { return width_; }
  int height() const { return height_; }
  GLuint id() const { return texture_; }

 private:
  const Gl& gl_;
  GLenum internalFormat_, format_, type_;
  GLuint texture_ = 0;
  int width_ = 0, height_ = 0;
};

/// A buffer of one record of floats for each instance of a quad, with its layout.
class GlInstances {
 public:
  /// `components`: of each attribute, in the order of their locations.
  GlInstances(const Gl& gl, std::vector<int> components);
  ~GlInstances();
  GlInstances(const GlInstances&) = delete;
  GlInstances& operator=(const GlInstances&) = delete;

  /// Draws a quad (a strip of four vertices) for each record.
  void draw(const std::vector<float>& records);

 private:
  const Gl& gl_;
  GLuint vertexArray_ = 0, buffer_ = 0;
  int recordFloats_ = 0;
};

/// Our own colour target: 8-bit sRGB, blended in linear light. Row 0 is the top of the picture.
class GlTarget {
 public:
  GlTarget(const Gl& gl, int width, int height);
  ~GlTarget();
  GlTarget(const GlTarget&) = delete;
  GlTarget& operator=(const GlTarget&) = delete;
  void bind() const;
  /// Replaces the whole picture; the unpack alignment is taken to suit, for a pixel has 4 bytes.
  void write(const void* rgba) { color_.upload(width_, height_, rgba); }
  /// Waits until all is drawn, and copies it out.
  void read(unsigned char* rgba) const;

 private:
  const Gl& gl_;
  int width_, height_;
  GlTexture color_;
  GLuint framebuffer_ = 0;
};

}  // namespace smokebox
