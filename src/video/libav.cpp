#include "video/libav.h"

#include <cerrno>
#include <new>

#include "base/errors.h"

namespace smokebox::libav {

std::string errorText(int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, text, sizeof text);
  return text;
}

int check(int code, const std::string& what) {
  if (code == AVERROR(ENOMEM)) throw std::bad_alloc();
  if (code < 0) throw VideoError(what + ": " + errorText(code));
  return code;
}

int checkWrite(int code, const std::string& what) {
  if (code == AVERROR(ENOSPC) || code == AVERROR(EIO) || code == AVERROR(EFBIG) || code == AVERROR(EDQUOT) ||
      code == AVERROR(EPIPE) || code == AVERROR(EACCES) || code == AVERROR(EPERM) || code == AVERROR(EROFS) ||
      code == AVERROR(ENOENT) || code == AVERROR(ENOTDIR) || code == AVERROR(EISDIR) ||
      code == AVERROR(EMFILE) || code == AVERROR(ESPIPE) || code == AVERROR(EBADF))
    throw IoError(what + ": " + errorText(code));
  return check(code, what);
}

int checkRead(int code, const std::string& file) {
  if (code == AVERROR(ENOMEM)) throw std::bad_alloc();
  if (code < 0) throw IoError(file + ": cannot be read: " + errorText(code));
  return code;
}

Frame makeFrame(int width, int height, AVPixelFormat format) {
  Frame frame(allocated(av_frame_alloc()));
  frame->width = width;
  frame->height = height;
  frame->format = format;
  check(av_frame_get_buffer(frame.get(), 0),
        "a frame of " + std::to_string(width) + "x" + std::to_string(height));
  return frame;
}

}  // namespace smokebox::libav
