// Reads a film back with libav, as a player would.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "video/libav.h"

namespace smokebox {

struct DecodedFilm {
  AVPixelFormat pixelFormat = AV_PIX_FMT_NONE;
  AVCodecID codec = AV_CODEC_ID_NONE;
  AVColorSpace matrix = AVCOL_SPC_UNSPECIFIED;
  AVColorPrimaries primaries = AVCOL_PRI_UNSPECIFIED;
  AVColorTransferCharacteristic transfer = AVCOL_TRC_UNSPECIFIED;
  AVColorRange range = AVCOL_RANGE_UNSPECIFIED;
  int width = 0, height = 0;
  double framesPerSecond = 0, duration = 0;  // s
  std::vector<double> times;                 // s, of each frame
  std::map<std::string, std::string> metadata;
  /// Components 0..2 of the pixel in the middle of each frame, as stored.
  std::vector<std::array<int, 3>> middle;
};

inline DecodedFilm decodeFilm(const std::filesystem::path& file) {
  DecodedFilm film;
  AVFormatContext* raw = nullptr;
  libav::check(avformat_open_input(&raw, ("file:" + file.string()).c_str(), nullptr, nullptr), file.string());
  struct Close {
    void operator()(AVFormatContext* p) const { avformat_close_input(&p); }
  };
  const std::unique_ptr<AVFormatContext, Close> input(raw);
  libav::check(avformat_find_stream_info(raw, nullptr), "streams");
  const AVCodec* codec = nullptr;
  const int index =
      libav::check(av_find_best_stream(raw, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0), "video stream");
  const AVStream* stream = raw->streams[index];
  const libav::Codec decoder(avcodec_alloc_context3(codec));
  libav::check(avcodec_parameters_to_context(decoder.get(), stream->codecpar), "parameters");
  libav::check(avcodec_open2(decoder.get(), codec, nullptr), "decoder");
  film.codec = stream->codecpar->codec_id;
  film.width = stream->codecpar->width;
  film.height = stream->codecpar->height;
  film.framesPerSecond = av_q2d(stream->avg_frame_rate);
  film.duration = static_cast<double>(raw->duration) / AV_TIME_BASE;
  for (const AVDictionaryEntry* entry = nullptr;
       (entry = av_dict_get(raw->metadata, "", entry, AV_DICT_IGNORE_SUFFIX)) != nullptr;)
    film.metadata[entry->key] = entry->value;

  const libav::Packet packet(av_packet_alloc());
  const libav::Frame frame(av_frame_alloc());
  const auto receive = [&] {
    while (avcodec_receive_frame(decoder.get(), frame.get()) >= 0) {
      film.pixelFormat = static_cast<AVPixelFormat>(frame->format);
      film.matrix = frame->colorspace;
      film.primaries = frame->color_primaries;
      film.transfer = frame->color_trc;
      film.range = frame->color_range;
      film.times.push_back(static_cast<double>(frame->best_effort_timestamp) * av_q2d(stream->time_base));
      const int x = frame->width / 2, y = frame->height / 2;
      if (film.pixelFormat == AV_PIX_FMT_YUV420P)
        film.middle.push_back({frame->data[0][y * frame->linesize[0] + x],
                               frame->data[1][y / 2 * frame->linesize[1] + x / 2],
                               frame->data[2][y / 2 * frame->linesize[2] + x / 2]});
      else  // bgr0
        film.middle.push_back({frame->data[0][y * frame->linesize[0] + 4 * x + 2],
                               frame->data[0][y * frame->linesize[0] + 4 * x + 1],
                               frame->data[0][y * frame->linesize[0] + 4 * x]});
    }
  };
  while (av_read_frame(raw, packet.get()) >= 0) {
    if (packet->stream_index == index) {
      libav::check(avcodec_send_packet(decoder.get(), packet.get()), "packet");
      receive();
    }
    av_packet_unref(packet.get());
  }
  libav::check(avcodec_send_packet(decoder.get(), nullptr), "flush");
  receive();
  return film;
}

/// sRGB-encoded components of a colour of BT.709, limited range, after the definition in ITU-R BT.709.
inline std::array<double, 3> rgbOfBt709(const std::array<int, 3>& yuv) {
  const double y = (yuv[0] - 16) / 219.0, cb = (yuv[1] - 128) / 224.0, cr = (yuv[2] - 128) / 224.0;
  const double r = y + 1.5748 * cr, b = y + 1.8556 * cb;
  return {255 * r, 255 * (y - 0.2126 * r - 0.0722 * b) / 0.7152, 255 * b};
}

}  // namespace smokebox
