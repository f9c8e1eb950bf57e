#include "render/gl_objects.h"

#include <algorithm>
#include <utility>

#include "base/errors.h"
#include "render/shader_files.h"

namespace smokebox {

std::string shaderSource(std::string_view name) {
  const ShaderFile* const end = kShaderFiles + kShaderFileCount;
  const ShaderFile* file =
      std::find_if(kShaderFiles, end, [&](const ShaderFile& f) { return name == f.name; });
  if (file == end) throw GlError("no shader file " + std::string(name) + " was built in");
  std::string text = file->text;
  constexpr std::string_view kInclude = "#include \"";
  for (std::size_t at; (at = text.find(kInclude)) != std::string::npos;) {
    const std::size_t nameStart = at + kInclude.size();
    const std::size_t nameEnd = text.find('"', nameStart);
    text.replace(at, nameEnd + 1 - at, shaderSource(text.substr(nameStart, nameEnd - nameStart)));
  }
  return text;
}

namespace {
GLuint compiled(const Gl& gl, GLenum kind, std::string_view file, const std::string& defines) {
  std::string text = shaderSource(file);
  text.insert(text.find('\n') + 1, defines);
  const GLuint shader = gl.CreateShader(kind);
  const char* source = text.c_str();
  gl.ShaderSource(shader, 1, &source, nullptr);
  gl.CompileShader(shader);
  GLint good = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (!good) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(length);
    gl.DeleteShader(shader);
    throw GlError("shader " + std::string(file) + " does not compile: " + log);
  }
  return shader;
}
}  // namespace

GlProgram::GlProgram(const Gl& gl, std::string_view vertexFile, std::string_view fragmentFile,
                     const std::string& defines)
    : gl_(gl) {
  const GLuint vertex = compiled(gl, GL_VERTEX_SHADER, vertexFile, defines);
  const GLuint fragment = compiled(gl, GL_FRAGMENT_SHADER, fragmentFile, defines);
  program_ = gl.CreateProgram();
  gl.AttachShader(program_, vertex);
  gl.AttachShader(program_, fragment);
  gl.LinkProgram(program_);
  gl.DeleteShader(vertex);
  gl.DeleteShader(fragment);
  GLint good = 0;
  gl.GetProgramiv(program_, GL_LINK_STATUS, &good);
  if (!good) {
    std::string log(4096, '\0');
    GLsizei length = 0;
    gl.GetProgramInfoLog(program_, static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(length);
    gl.DeleteProgram(program_);
    throw GlError("shaders " + std::string(vertexFile) + " and " + std::string(fragmentFile) +
                  " do not link: " + log);
  }
}

GlProgram::~GlProgram() { gl_.DeleteProgram(program_); }

GlTexture::GlTexture(const Gl& gl, GLenum internalFormat, GLenum format, GLenum type, GLenum filter)
    : gl_(gl), internalFormat_(internalFormat), format_(format), type_(type) {
  gl.GenTextures(1, &texture_);
  gl.BindTexture(GL_TEXTURE_2D, texture_);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

GlTexture::~GlTexture() { gl_.DeleteTextures(1, &texture_); }

void GlTexture::bind(int unit) const {
  gl_.ActiveTexture(GL_TEXTURE0 + unit);
  gl_.BindTexture(GL_TEXTURE_2D, texture_);
}

void GlTexture::reserve(int width, int height) {
  if (width <= width_ && height <= height_) return;
  GLint most = 0;
  gl_.GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (width > most || height > most)
    throw GlError("a texture of " + std::to_string(width) + "x" + std::to_string(height) +
                  " is needed, and this OpenGL ends at " + std::to_string(most));
  width_ = std::max(width, width_);
  height_ = std::max(height, height_);
  gl_.BindTexture(GL_TEXTURE_2D, texture_);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internalFormat_), width_, height_, 0, format_, type_,
                 nullptr);
}

void GlTexture::upload(int width, int height, const void* texels) {
  reserve(width, height);
  gl_.BindTexture(GL_TEXTURE_2D, texture_);
  gl_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, format_, type_, texels);
}

GlInstances::GlInstances(const Gl& gl, std::vector<int> components) : gl_(gl) {
  gl.GenVertexArrays(1, &vertexArray_);
  gl.GenBuffers(1, &buffer_);
  gl.BindVertexArray(vertexArray_);
  gl.BindBuffer(GL_ARRAY_BUFFER, buffer_);
  for (int count : components) recordFloats_ += count;
  std::size_t offset = 0;
  for (GLuint k = 0; k < components.size(); ++k) {
    gl.EnableVertexAttribArray(k);
    gl.VertexAttribPointer(k, components[k], GL_FLOAT, GL_FALSE,
                           recordFloats_ * static_cast<GLsizei>(sizeof(float)),
                           reinterpret_cast<const void*>(offset));
    gl.VertexAttribDivisor(k, 1);
    offset += components[k] * sizeof(float);
  }
}

GlInstances::~GlInstances() {
  gl_.DeleteBuffers(1, &buffer_);
  gl_.DeleteVertexArrays(1, &vertexArray_);
}

void GlInstances::draw(const std::vector<float>& records) {
  if (records.empty()) return;
  gl_.BindVertexArray(vertexArray_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(records.size() * sizeof(float)), records.data(),
                 GL_STREAM_DRAW);
  gl_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(records.size()) / recordFloats_);
}

GlTarget::GlTarget(const Gl& gl, int width, int height)
    : gl_(gl),
      width_(width),
      height_(height),
      color_(gl, GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_NEAREST) {
  color_.reserve(width, height);
  gl.GenFramebuffers(1, &framebuffer_);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.id(), 0);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw GlError("no framebuffer of " + std::to_string(width) + "x" + std::to_string(height) +
                  " can be had");
}

GlTarget::~GlTarget() { gl_.DeleteFramebuffers(1, &framebuffer_); }

void GlTarget::bind() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, width_, height_);
}

void GlTarget::read(unsigned char* rgba) const {
  gl_.Finish();
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
}

}  // namespace smokebox
