// Decoded frames to RGB by libswscale: bit exact, accurate rounding, chroma sited and interpolated, with the
// matrix and the range that the frame is tagged with. What is not tagged is taken as players take it: YCbCr
// is of limited range, and of BT.709 from 1280 columns or above 576 lines, else of BT.601; greys are of full
// range. Alpha is dropped.
#pragma once
#include <memory>
#include <string>

#include "image/image.h"
#include "video/libav.h"

struct SwsContext;

namespace smokebox {

class RgbConverter {
 public:
  /// `file`: names the film in errors.
  explicit RgbConverter(std::string file);
  ~RgbConverter();
  RgbConverter(const RgbConverter&) = delete;
  RgbConverter& operator=(const RgbConverter&) = delete;

  /// Throws IoError if the colours are of a kind that is not known here.
  void convert(const AVFrame& frame, Image& image);

 private:
  struct FreeScaler {
    void operator()(SwsContext* p) const;
  };
  using Scaler = std::unique_ptr<SwsContext, FreeScaler>;
  /// What the conversion of a frame depends on.
  struct Colours {
    int width, height, format, matrix, range, chroma;
    bool operator==(const Colours&) const = default;
  };
  Scaler open(const AVFrame& frame) const;

  std::string file_;
  Scaler scaler_;
  libav::Frame rgb_;
  Colours colours_{};
};

}  // namespace smokebox
