#include "app/film_difference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "app/interrupt.h"
#include "base/threads.h"

namespace smokebox {

namespace {

/// The inverse of the definition of the ratio: 0 for an infinite one.
double meanSquare(double psnr) { return 255.0 * 255.0 * std::pow(10.0, -psnr / 10); }

/// Reads what is left, for its number.
long countRest(FilmReader& film) {
  for (Image image; film.next(image);) throwIfInterrupted();
  return film.count();
}

}  // namespace

FilmDifference measureFilms(FilmReader& a, FilmReader& b, const DifferenceTolerance& tolerance,
                            const std::function<void(const ComparedFrame&)>& seen) {
  FilmDifference film;
  ThreadPool pool(hardwareThreads());
  std::vector<ComparedFrame> batch(pool.threads());
  double squares = 0, similarity = 0;
  bool worstBreaks = false;
  const auto take = [&](ComparedFrame& frame) {
    const ImageDifference& difference = frame.difference;
    const bool breaks = !difference.within(tolerance);
    if (breaks && film.outside++ == 0) film.first = frame.number;
    squares += meanSquare(difference.psnr);
    similarity += difference.ssim;
    seen(frame);
    const bool noisier = difference.psnr < film.worst.difference.psnr;
    if (frame.number == 0 || breaks > worstBreaks || (breaks == worstBreaks && noisier)) {
      worstBreaks = breaks;
      std::swap(film.worst, frame);
    }
  };
  for (bool more = true; more;) {
    int filled = 0;
    while (filled < static_cast<int>(batch.size()) && more) {
      throwIfInterrupted();
      ComparedFrame& frame = batch[filled];
      more = a.next(frame.a) && b.next(frame.b);
      if (!more) break;
      frame.number = film.compared++;
      ++filled;
    }
    pool.blocks(0, filled, 1, [&](int k, int) {
      batch[k].difference = measureDifference(batch[k].a, batch[k].b, tolerance);
    });
    for (int k = 0; k < filled; ++k) take(batch[k]);
  }
  film.framesA = countRest(a);
  film.framesB = countRest(b);
  if (film.compared == 0) return film;
  const double mean = squares / film.compared;
  film.psnr = mean > 0 ? 10 * std::log10(255.0 * 255.0 / mean) : std::numeric_limits<double>::infinity();
  film.ssim = similarity / film.compared;
  return film;
}

}  // namespace smokebox
