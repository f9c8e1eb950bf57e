#include "video/yuv.h"

extern "C" {
#include <libavutil/opt.h>
}

#include "base/errors.h"

namespace smokebox {

using libav::check;

YuvConverter::YuvConverter(int width, int height) : scaler_(libav::allocated(sws_alloc_context())) {
  SwsContext* scaler = scaler_.get();
  const auto set = [&](const char* option, int value) {
    check(av_opt_set_int(scaler, option, value, 0), option);
  };
  set("srcw", width);
  set("srch", height);
  set("src_format", AV_PIX_FMT_RGB0);
  set("dstw", width);
  set("dsth", height);
  set("dst_format", AV_PIX_FMT_YUV420P);
  set("sws_flags", SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP);
  set("dst_h_chr_pos", 0);
  set("dst_v_chr_pos", 128);
  // Without this swscale would take the matrix of standard definition, and colours would be off in every
  // player.
  const int* matrix = sws_getCoefficients(SWS_CS_ITU709);
  const int unit = 1 << 16;
  check(sws_setColorspaceDetails(scaler, matrix, 1, matrix, 0, 0, unit, unit), "BT.709 matrix");
  check(sws_init_context(scaler, nullptr, nullptr), "conversion to YCbCr");
}

void YuvConverter::convert(const Image& image, AVFrame& frame) {
  checkInvariant(image.width == frame.width && image.height == frame.height,
                 "every frame of a film has its size");
  const std::uint8_t* source[4] = {image.rgba.data(), nullptr, nullptr, nullptr};
  const int stride[4] = {4 * image.width, 0, 0, 0};
  check(sws_scale(scaler_.get(), source, stride, 0, image.height, frame.data, frame.linesize),
        "conversion to YCbCr");
}

}  // namespace smokebox
