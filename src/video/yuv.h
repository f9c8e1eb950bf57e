// RGB to the YCbCr of high-definition video: BT.709 matrix, limited range (Y 16..235), 4:2:0 with chroma
// sited as H.264 and MPEG-2 have it (left, vertically centred).
#pragma once
#include "image/image.h"
#include "video/libav.h"

namespace smokebox {

class YuvConverter {
 public:
  YuvConverter(int width, int height);
  /// `frame`: yuv420p of the same size, writable.
  void convert(const Image& image, AVFrame& frame);

 private:
  libav::Scaler scaler_;
};

}  // namespace smokebox
