// How far apart two pictures are, and where: the measure of the golden tests and of `smokebox diff`.
//
// Four things are looked at. Pixels that are off by more than a few levels are counted, over the whole
// picture and in every window, so that a small thing that moved shows. A window that is shifted as a whole
// shows even if no pixel of it is off: by its mean difference, once the shift of the whole picture (a matter
// of rounding) is taken out and if it stands clear of the window's own scatter. Peak signal to noise ratio
// and structural similarity are for information.
#pragma once
#include <string>

#include "image/image.h"

namespace smokebox {

struct DifferenceTolerance {
  static constexpr int kWindow = 16;  // pixels along a side of a window

  int level = 2;              // a pixel is off if a channel is off by more than this, of 255
  double pixelsOff = 0.0005;  // share of the picture's pixels that may be
  double windowOff = 0.10;    // share of a window's
  double windowShift = 0.25;  // levels of 255 by which the mean of a window may differ in a channel
};

struct ImageDifference {
  struct Window {
    int x = 0, y = 0;  // top left corner
    double value = 0;
  };

  double pixelsOff = 0;  // share, 0..1
  Window worstWindow;    // largest share of pixels off, 0..1
  Window worstShift;     // largest significant shift, levels of 255
  int largest = 0;       // of all channels of all pixels, levels of 255
  double psnr = 0;       // dB over R, G, B; infinite for equal pictures
  double ssim = 1;       // of the luma: Wang et al. 2004, Gaussian window of 11x11, sigma 1.5

  bool equal() const { return largest == 0; }
  bool within(const DifferenceTolerance& tolerance) const;
  /// "0.12% of the pixels off by more than 2 levels (0.05% may be); ...", what breaks the tolerance first.
  std::string inWords(const DifferenceTolerance& tolerance) const;
  /// Only what breaks the tolerance, in the same words; empty if nothing does.
  std::string whatBreaks(const DifferenceTolerance& tolerance) const;
};

/// Both of one size (else an InvariantError). Alpha is not looked at.
ImageDifference measureDifference(const Image& a, const Image& b, const DifferenceTolerance& tolerance = {});

/// Shows where: `a` dimmed and without colour, and over it, the stronger the larger, what differs: faint blue
/// up to the level of the tolerance, yellow to red above. The worst window is framed if it breaks the
/// tolerance and `frameWorst` asks for it.
Image differencePicture(const Image& a, const Image& b, const DifferenceTolerance& tolerance = {},
                        bool frameWorst = true);

}  // namespace smokebox
