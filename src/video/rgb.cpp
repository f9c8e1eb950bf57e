#include "video/rgb.h"

extern "C" {
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

#include <utility>

#include "base/errors.h"

namespace smokebox {

using libav::allocated;
using libav::checkRead;

namespace {

/// As players choose when a film does not say.
int matrixOf(const AVFrame& frame, const std::string& file) {
  if (frame.colorspace == AVCOL_SPC_UNSPECIFIED || frame.colorspace == AVCOL_SPC_RESERVED)
    return frame.width >= 1280 || frame.height > 576 ? SWS_CS_ITU709 : SWS_CS_ITU601;
  switch (frame.colorspace) {
    case AVCOL_SPC_BT709:
      return SWS_CS_ITU709;
    case AVCOL_SPC_FCC:
      return SWS_CS_FCC;
    case AVCOL_SPC_BT470BG:
    case AVCOL_SPC_SMPTE170M:
      return SWS_CS_ITU601;
    case AVCOL_SPC_SMPTE240M:
      return SWS_CS_SMPTE240M;
    case AVCOL_SPC_BT2020_NCL:
      return SWS_CS_BT2020;
    default:
      break;
  }
  const char* const name = av_color_space_name(frame.colorspace);
  throw IoError(file + ": its colours are of a matrix that is not known here (" + (name ? name : "no name") +
                ")");
}

/// The old way to say "full range".
bool isFullRangeForm(AVPixelFormat format) {
  return format == AV_PIX_FMT_YUVJ420P || format == AV_PIX_FMT_YUVJ422P || format == AV_PIX_FMT_YUVJ444P ||
         format == AV_PIX_FMT_YUVJ440P || format == AV_PIX_FMT_YUVJ411P;
}

}  // namespace

void RgbConverter::FreeScaler::operator()(SwsContext* p) const { sws_freeContext(p); }

RgbConverter::RgbConverter(std::string file) : file_(std::move(file)) {}

RgbConverter::~RgbConverter() = default;

void RgbConverter::convert(const AVFrame& frame, Image& image) {
  const Colours colours{frame.width,      frame.height,      frame.format,
                        frame.colorspace, frame.color_range, frame.chroma_location};
  if (!scaler_ || colours != colours_) {
    scaler_ = open(frame);
    rgb_ = libav::makeFrame(frame.width, frame.height, AV_PIX_FMT_RGB0);
    colours_ = colours;
  }
  // Not straight into the image: libswscale may write beyond the end of a row that is not padded.
  checkRead(sws_scale(scaler_.get(), frame.data, frame.linesize, 0, frame.height, rgb_->data, rgb_->linesize),
            file_);
  if (image.width != frame.width || image.height != frame.height) image = Image(frame.width, frame.height);
  auto* to = reinterpret_cast<std::uint32_t*>(image.rgba.data());  // R is the lowest byte
  for (int y = 0; y < frame.height; ++y, to += frame.width) {
    const auto* const from =
        reinterpret_cast<const std::uint32_t*>(rgb_->data[0] + std::ptrdiff_t{y} * rgb_->linesize[0]);
    for (int x = 0; x < frame.width; ++x) to[x] = from[x] | 0xFF000000u;
  }
}

RgbConverter::Scaler RgbConverter::open(const AVFrame& frame) const {
  const auto format = static_cast<AVPixelFormat>(frame.format);
  const AVPixFmtDescriptor* const known = av_pix_fmt_desc_get(format);
  if (!known || !sws_isSupportedInput(format))
    throw IoError(file_ + ": its pictures are of a form that libswscale does not know");
  Scaler scaler(allocated(sws_alloc_context()));
  const auto set = [&](const char* option, int value) {
    checkRead(av_opt_set_int(scaler.get(), option, value, 0), file_);
  };
  set("srcw", frame.width);
  set("srch", frame.height);
  set("src_format", format);
  set("dstw", frame.width);
  set("dsth", frame.height);
  set("dst_format", AV_PIX_FMT_RGB0);
  // Bilinear would be enough, but in the libswscale of FFmpeg 5.1 it puts the chroma half a line too low.
  set("sws_flags", SWS_BICUBIC | SWS_ACCURATE_RND | SWS_BITEXACT | SWS_FULL_CHR_H_INT);

  const bool rgb = known->flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL);
  const bool grey = known->nb_components < 3 && !rgb;
  const bool full = frame.color_range == AVCOL_RANGE_JPEG || isFullRangeForm(format) ||
                    (grey && frame.color_range == AVCOL_RANGE_UNSPECIFIED);
  if (!rgb && (known->log2_chroma_w || known->log2_chroma_h)) {
    AVChromaLocation where = frame.chroma_location;
    if (where == AVCHROMA_LOC_UNSPECIFIED) where = full ? AVCHROMA_LOC_CENTER : AVCHROMA_LOC_LEFT;
    int x = 0, y = 0;
    checkRead(avcodec_enum_to_chroma_pos(&x, &y, where), file_);
    if (known->log2_chroma_w) set("src_h_chr_pos", x);
    if (known->log2_chroma_h) set("src_v_chr_pos", y);
  }
  checkRead(sws_init_context(scaler.get(), nullptr, nullptr), file_);
  if (!rgb) {
    constexpr int kOne = 1 << 16;
    // Greys have no matrix, whatever they are tagged with.
    const int* const matrix = sws_getCoefficients(grey ? SWS_CS_DEFAULT : matrixOf(frame, file_));
    checkRead(sws_setColorspaceDetails(scaler.get(), matrix, full, sws_getCoefficients(SWS_CS_DEFAULT), 1, 0,
                                       kOne, kOne),
              file_);
  }
  return scaler;
}

}  // namespace smokebox
