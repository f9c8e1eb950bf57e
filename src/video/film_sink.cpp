#include "video/film_sink.h"

#include <cstring>

#include "base/errors.h"

namespace smokebox {

using libav::allocated;
using libav::check;
using libav::checkWrite;
using libav::Dictionary;

namespace {

// More threads would cut x264's motion search differently; a fixed number keeps the bytes of a film the same
// on every machine that has the same x264. Two keep ahead of the simulation, and leave it the other cores.
constexpr int kEncoderThreads = 2;

// What x264's preset does beyond this costs half as much time again, and makes films of smoke 10 to 20%
// smaller at the same error (wake, 1280x720: 14 ms a frame instead of 9, 50 dB both times).
constexpr const char* kX264Parameters = "bframes=0:weightp=0:subme=1";

std::string sizeText(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

}  // namespace

FilmSink::FilmSink(const std::string& output, const FilmFormat& format, Codec codec)
    : output_(output), kind_(codec), part_(output) {
  av_log_set_level(AV_LOG_QUIET);  // what goes wrong comes back as a code, and is said once, by us
  openEncoder(format);
  openMuxer(format);
}

void FilmSink::openEncoder(const FilmFormat& format) {
  const bool h264 = kind_ == Codec::h264;
  if (h264 && (format.width % 2 || format.height % 2))
    throw VideoError(output_ + ": " + sizeText(format.width, format.height) +
                     ": H.264 in yuv420p needs even width and height; try " +
                     sizeText(format.width - format.width % 2, format.height - format.height % 2) +
                     ", or .mkv");
  const char* name = h264 ? "libx264" : "ffv1";
  const AVCodec* codec = avcodec_find_encoder_by_name(name);
  if (!codec) throw VideoError(output_ + ": the libavcodec of this machine has no encoder " + name);
  encoder_.reset(allocated(avcodec_alloc_context3(codec)));
  encoder_->width = format.width;
  encoder_->height = format.height;
  encoder_->time_base = AVRational{1, format.fps};
  encoder_->framerate = AVRational{format.fps, 1};
  encoder_->sample_aspect_ratio = AVRational{1, 1};
  encoder_->thread_count = kEncoderThreads;
  encoder_->flags |= AV_CODEC_FLAG_BITEXACT | AV_CODEC_FLAG_GLOBAL_HEADER;
  encoder_->color_primaries = AVCOL_PRI_BT709;
  Dictionary options;
  if (h264) {
    encoder_->pix_fmt = AV_PIX_FMT_YUV420P;
    encoder_->colorspace = AVCOL_SPC_BT709;
    encoder_->color_trc = AVCOL_TRC_BT709;
    encoder_->color_range = AVCOL_RANGE_MPEG;
    encoder_->chroma_sample_location = AVCHROMA_LOC_LEFT;
    options.set("preset", "veryfast");
    options.set("crf", "18");
    options.set("x264-params", kX264Parameters);
    yuv_.emplace(format.width, format.height);
  } else {
    encoder_->pix_fmt = AV_PIX_FMT_0RGB32;
    encoder_->colorspace = AVCOL_SPC_RGB;
    encoder_->color_trc = AVCOL_TRC_IEC61966_2_1;
    encoder_->color_range = AVCOL_RANGE_JPEG;
    encoder_->level = 3;  // the version of FFV1 that is cut into slices, each with a checksum
    encoder_->gop_size = 1;
    options.set("slicecrc", "1");
  }
  check(avcodec_open2(encoder_.get(), codec, options.handle()),
        output_ + ": " + name + " does not take " + sizeText(format.width, format.height));
  frame_ = libav::makeFrame(format.width, format.height, encoder_->pix_fmt);
  frame_->color_range = encoder_->color_range;
  frame_->colorspace = encoder_->colorspace;
  frame_->color_primaries = encoder_->color_primaries;
  frame_->color_trc = encoder_->color_trc;
  packet_.reset(allocated(av_packet_alloc()));
}

void FilmSink::openMuxer(const FilmFormat& format) {
  const bool mp4 = kind_ == Codec::h264;
  if (mp4 && part_.direct() && std::filesystem::is_fifo(part_.path()))
    throw IoError(output_ + ": is a pipe, and an MP4 file must be sought in; use -o - or .mkv");
  // With "file:" before it no name is taken for the address of some other protocol.
  const std::string url = "file:" + part_.path().string();
  AVFormatContext* muxer = nullptr;
  check(avformat_alloc_output_context2(&muxer, nullptr, mp4 ? "mp4" : "matroska", url.c_str()), output_);
  muxer_.reset(muxer);
  muxer_->flags |= AVFMT_FLAG_BITEXACT;  // no time of day, no version of the library
  stream_ = allocated(avformat_new_stream(muxer, nullptr));
  check(avcodec_parameters_from_context(stream_->codecpar, encoder_.get()), output_);
  stream_->time_base = encoder_->time_base;
  stream_->avg_frame_rate = encoder_->framerate;
  stream_->r_frame_rate = encoder_->framerate;
  for (const auto& [key, value] : format.metadata)
    check(av_dict_set(&muxer_->metadata, key.c_str(), value.c_str(), 0), key);

  AVIOContext* io = nullptr;
  checkWrite(avio_open2(&io, url.c_str(), AVIO_FLAG_WRITE, nullptr, nullptr), output_);
  io_.reset(io);
  muxer_->pb = io;
  Dictionary options;
  if (mp4) options.set("movflags", "+faststart+use_metadata_tags");
  checkWrite(avformat_write_header(muxer, options.handle()), output_);
}

void FilmSink::add(const Image& image, long) {
  check(av_frame_make_writable(frame_.get()), output_);
  if (yuv_) {
    yuv_->convert(image, *frame_);
  } else {
    checkInvariant(image.width == frame_->width && image.height == frame_->height,
                   "every frame of a film has its size");
    for (int y = 0; y < image.height; ++y) {
      const std::uint8_t* from = image.rgba.data() + std::size_t{4} * y * image.width;
      auto* to = reinterpret_cast<std::uint32_t*>(frame_->data[0] + std::ptrdiff_t{y} * frame_->linesize[0]);
      for (int x = 0; x < image.width; ++x)
        to[x] = std::uint32_t{from[4 * x]} << 16 | std::uint32_t{from[4 * x + 1]} << 8 | from[4 * x + 2];
    }
  }
  frame_->pts = count_++;
  encode(frame_.get());
}

void FilmSink::encode(const AVFrame* frame) {
  check(avcodec_send_frame(encoder_.get(), frame), output_);
  for (;;) {
    const int code = avcodec_receive_packet(encoder_.get(), packet_.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return;
    check(code, output_);
    packet_->duration = 1;  // without it the last frame would last no time
    packet_->stream_index = stream_->index;
    av_packet_rescale_ts(packet_.get(), encoder_->time_base, stream_->time_base);
    checkWrite(av_interleaved_write_frame(muxer_.get(), packet_.get()), output_);
    checkWrite(io_->error, output_);
  }
}

void FilmSink::finish() {
  encode(nullptr);
  checkWrite(av_write_trailer(muxer_.get()), output_);
  avio_flush(io_.get());
  checkWrite(io_->error, output_);
  checkWrite(avio_close(io_.release()), output_);
  part_.commit();
}

}  // namespace smokebox
