// The OpenGL 3.3 core functions that the renderer uses, found at run time through the context's own loader,
// so that nothing is linked against a particular OpenGL library. Types come from Khronos' glcorearb.h.
#pragma once
#include <GL/glcorearb.h>

// One line a function: the name without its prefix `gl`, and the type of its pointer.
#define SMOKEBOX_GL_FUNCTIONS(X)                               \
  X(GetString, PFNGLGETSTRINGPROC)                             \
  X(GetError, PFNGLGETERRORPROC)                               \
  X(GetIntegerv, PFNGLGETINTEGERVPROC)                         \
  X(Enable, PFNGLENABLEPROC)                                   \
  X(Disable, PFNGLDISABLEPROC)                                 \
  X(BlendFunc, PFNGLBLENDFUNCPROC)                             \
  X(Viewport, PFNGLVIEWPORTPROC)                               \
  X(ClearColor, PFNGLCLEARCOLORPROC)                           \
  X(Clear, PFNGLCLEARPROC)                                     \
  X(Finish, PFNGLFINISHPROC)                                   \
  X(PixelStorei, PFNGLPIXELSTOREIPROC)                         \
  X(ReadPixels, PFNGLREADPIXELSPROC)                           \
  X(GenTextures, PFNGLGENTEXTURESPROC)                         \
  X(DeleteTextures, PFNGLDELETETEXTURESPROC)                   \
  X(BindTexture, PFNGLBINDTEXTUREPROC)                         \
  X(ActiveTexture, PFNGLACTIVETEXTUREPROC)                     \
  X(TexImage2D, PFNGLTEXIMAGE2DPROC)                           \
  X(TexSubImage2D, PFNGLTEXSUBIMAGE2DPROC)                     \
  X(TexParameteri, PFNGLTEXPARAMETERIPROC)                     \
  X(GenFramebuffers, PFNGLGENFRAMEBUFFERSPROC)                 \
  X(DeleteFramebuffers, PFNGLDELETEFRAMEBUFFERSPROC)           \
  X(BindFramebuffer, PFNGLBINDFRAMEBUFFERPROC)                 \
  X(FramebufferTexture2D, PFNGLFRAMEBUFFERTEXTURE2DPROC)       \
  X(CheckFramebufferStatus, PFNGLCHECKFRAMEBUFFERSTATUSPROC)   \
  X(CreateShader, PFNGLCREATESHADERPROC)                       \
  X(DeleteShader, PFNGLDELETESHADERPROC)                       \
  X(ShaderSource, PFNGLSHADERSOURCEPROC)                       \
  X(CompileShader, PFNGLCOMPILESHADERPROC)                     \
  X(GetShaderiv, PFNGLGETSHADERIVPROC)                         \
  X(GetShaderInfoLog, PFNGLGETSHADERINFOLOGPROC)               \
  X(CreateProgram, PFNGLCREATEPROGRAMPROC)                     \
  X(DeleteProgram, PFNGLDELETEPROGRAMPROC)                     \
  X(AttachShader, PFNGLATTACHSHADERPROC)                       \
  X(LinkProgram, PFNGLLINKPROGRAMPROC)                         \
  X(GetProgramiv, PFNGLGETPROGRAMIVPROC)                       \
  X(GetProgramInfoLog, PFNGLGETPROGRAMINFOLOGPROC)             \
  X(UseProgram, PFNGLUSEPROGRAMPROC)                           \
  X(GetUniformLocation, PFNGLGETUNIFORMLOCATIONPROC)           \
  X(Uniform1i, PFNGLUNIFORM1IPROC)                             \
  X(Uniform1f, PFNGLUNIFORM1FPROC)                             \
  X(Uniform2f, PFNGLUNIFORM2FPROC)                             \
  X(Uniform4f, PFNGLUNIFORM4FPROC)                             \
  X(Uniform3fv, PFNGLUNIFORM3FVPROC)                           \
  X(GenVertexArrays, PFNGLGENVERTEXARRAYSPROC)                 \
  X(DeleteVertexArrays, PFNGLDELETEVERTEXARRAYSPROC)           \
  X(BindVertexArray, PFNGLBINDVERTEXARRAYPROC)                 \
  X(GenBuffers, PFNGLGENBUFFERSPROC)                           \
  X(DeleteBuffers, PFNGLDELETEBUFFERSPROC)                     \
  X(BindBuffer, PFNGLBINDBUFFERPROC)                           \
  X(BufferData, PFNGLBUFFERDATAPROC)                           \
  X(EnableVertexAttribArray, PFNGLENABLEVERTEXATTRIBARRAYPROC) \
  X(VertexAttribPointer, PFNGLVERTEXATTRIBPOINTERPROC)         \
  X(VertexAttribDivisor, PFNGLVERTEXATTRIBDIVISORPROC)         \
  X(DrawArraysInstanced, PFNGLDRAWARRAYSINSTANCEDPROC)

namespace smokebox {

struct Gl {
#define SMOKEBOX_GL_MEMBER(name, type) type name = nullptr;
  SMOKEBOX_GL_FUNCTIONS(SMOKEBOX_GL_MEMBER)
#undef SMOKEBOX_GL_MEMBER
};

}  // namespace smokebox
