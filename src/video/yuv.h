// RGB to the YCbCr of high-definition video: BT.709 matrix, limited range (Y 16..235), 4:2:0 with chroma
// sited as H.264 and MPEG-2 have it (left, vertically centred): (1 2 1)/4 of the columns, (1 1)/2 of the
// rows.
#pragma once
#include <vector>

#include "image/image.h"
#include "video/libav.h"

namespace smokebox {

class YuvConverter {
 public:
  YuvConverter(int width, int height);
  /// `frame`: yuv420p of the same size, writable.
  void convert(const Image& image, AVFrame& frame);

 private:
  int width_, height_;
  std::vector<int> red_, green_, blue_;  // sums of two rows; one pixel more on either side
};

}  // namespace smokebox
