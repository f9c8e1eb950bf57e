#include "video/y4m_sink.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "base/errors.h"

namespace smokebox {

Y4mSink::Y4mSink(int descriptor, std::string name, const FilmFormat& format)
    : descriptor_(descriptor),
      name_(std::move(name)),
      header_("YUV4MPEG2 W" + std::to_string(format.width) + " H" + std::to_string(format.height) + " F" +
              std::to_string(format.fps) + ":1 Ip A1:1 C420mpeg2 XYSCSS=420MPEG2 XCOLORRANGE=LIMITED\n"),
      yuv_(format.width, format.height),
      frame_(libav::makeFrame(format.width, format.height, AV_PIX_FMT_YUV420P)) {
  av_log_set_level(AV_LOG_QUIET);
}

void Y4mSink::add(const Image& image, long) {
  yuv_.convert(image, *frame_);
  buffer_.assign(header_.begin(), header_.end());  // before the first frame only
  header_.clear();
  const std::string_view mark = "FRAME\n";
  buffer_.insert(buffer_.end(), mark.begin(), mark.end());
  for (int plane = 0; plane < 3; ++plane) {
    const int width = plane ? (image.width + 1) / 2 : image.width;
    const int height = plane ? (image.height + 1) / 2 : image.height;
    for (int y = 0; y < height; ++y) {
      const std::uint8_t* row = frame_->data[plane] + std::ptrdiff_t{y} * frame_->linesize[plane];
      buffer_.insert(buffer_.end(), row, row + width);
    }
  }
  write(buffer_.data(), buffer_.size());
}

void Y4mSink::finish() {}

void Y4mSink::write(const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(descriptor_, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw IoError(name_ + ": " + std::strerror(errno));
    at += written;
    size -= static_cast<std::size_t>(written);
  }
}

}  // namespace smokebox
