// How far apart two films are, frame by frame: what `smokebox diff` says of films.
#pragma once
#include <functional>
#include <optional>

#include "image/difference.h"
#include "video/film_reader.h"

namespace smokebox {

/// A frame that both films have, and what was found there.
struct ComparedFrame {
  long number = 0;
  ImageDifference difference;
  Image a, b;
};

struct FilmDifference {
  long compared = 0;  // frames that both films have
  long framesA = 0, framesB = 0;
  long outside = 0;           // of the tolerance
  std::optional<long> first;  // of those
  ComparedFrame worst;        // of those, if there are any, the noisiest
  double psnr = 0;            // of the mean squared error of all compared frames
  double ssim = 1;            // mean
};

/// Reads both to their ends. Films of one size; nothing is compared if one has no frame. `seen` is called
/// with the pictures of each compared frame, in order.
FilmDifference measureFilms(FilmReader& a, FilmReader& b, const DifferenceTolerance& tolerance,
                            const std::function<void(const ComparedFrame&)>& seen);

}  // namespace smokebox
