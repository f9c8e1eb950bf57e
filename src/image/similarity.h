// Structural similarity of two pictures: Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli, "Image quality
// assessment: from error visibility to structural similarity", IEEE Trans. Image Processing 13 (2004),
// equation 13 and section III.C: a Gaussian window of 11x11 with sigma 1.5, K1 = 0.01, K2 = 0.03, L = 255.
//
// Of the luma of BT.709, unrounded. The mean is over the windows that lie wholly in the picture, as in the
// authors' own program; in a direction in which the picture is smaller than the window, the window is cut to
// the largest odd size that fits, and its weights made to sum to 1 again.
#pragma once
#include "image/image.h"

namespace smokebox {

/// 1 for equal pictures, to the bit. Both of one size (else an InvariantError), with at least one pixel.
double structuralSimilarity(const Image& a, const Image& b);

}  // namespace smokebox
