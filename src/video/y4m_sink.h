// Uncompressed YUV4MPEG2 on a file descriptor, for piping into other programs.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "video/sink.h"
#include "video/yuv.h"

namespace smokebox {

class Y4mSink : public FrameSink {
 public:
  /// Writes to `descriptor`, which stays open; `name` stands for it in messages.
  Y4mSink(int descriptor, std::string name, const FilmFormat& format);

  void add(const Image& image, long frame) override;
  void finish() override;

 private:
  /// Writes all of it. Throws IoError (a full disk, a reader that has gone).
  void write(const void* data, std::size_t size);

  int descriptor_;
  std::string name_, header_;
  std::vector<std::uint8_t> buffer_;  // one frame as it goes out
  YuvConverter yuv_;
  libav::Frame frame_;
};

}  // namespace smokebox
