// Encoded films by libav: H.264 in MP4 for watching, FFV1 in Matroska without any loss.
#pragma once
#include <optional>
#include <string>

#include "base/part_file.h"
#include "video/libav.h"
#include "video/sink.h"
#include "video/yuv.h"

namespace smokebox {

class FilmSink : public FrameSink {
 public:
  enum class Codec { h264, ffv1 };
  FilmSink(const std::string& output, const FilmFormat& format, Codec codec);

  void add(const Image& image, long frame) override;
  void finish() override;

 private:
  void openEncoder(const FilmFormat& format);
  void openMuxer(const FilmFormat& format);
  /// Hands a frame (null: no more) to the encoder and writes what comes out.
  void encode(const AVFrame* frame);

  std::string output_;
  Codec kind_;
  PartFile part_;  // before the handles: they are closed before it is removed
  libav::Io io_;
  libav::Format muxer_;
  libav::Codec encoder_;
  libav::Frame frame_;
  libav::Packet packet_;
  std::optional<YuvConverter> yuv_;
  AVStream* stream_ = nullptr;  // of the muxer
  long count_ = 0;
};

}  // namespace smokebox
