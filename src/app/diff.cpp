// `smokebox diff A B`: two pictures or two films, by the tolerance of the golden tests.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "app/commands.h"
#include "app/film_difference.h"
#include "app/interrupt.h"
#include "base/errors.h"
#include "image/difference.h"
#include "image/png.h"
#include "video/film_reader.h"
#include "video/png_sinks.h"
#include "video/sink.h"

namespace smokebox {
namespace fs = std::filesystem;

namespace {

constexpr double kSameRate = 5e-4;  // relative: Matroska rounds times, and 29.97 is not 30 frames/s
constexpr int kDefaultFps = 30;     // of the differences of two folders of pictures

/// Throws IoError if there is nothing of this name.
bool isPicture(const std::string& file) {
  std::error_code error;
  if (fs::is_directory(file, error))
    throw IoError(file + ": is a folder; name its frames, such as " + (fs::path(file) / "%05d.png").string());
  if (!fs::exists(file, error)) {
    if (FramePattern::parse(file)) return false;
    throw IoError(file + ": cannot be read: No such file or directory");
  }
  if (!fs::is_regular_file(file, error)) return false;
  char start[4096] = {};
  std::ifstream in(file, std::ios::binary);
  in.read(start, sizeof start);
  const std::string_view head(start, static_cast<std::size_t>(in.gcount()));
  if (!head.starts_with("\x89PNG\r\n\x1a\n")) return fs::path(file).extension() == ".png";  // a broken one
  // The chunk that makes an animation of it stands before the pixels.
  return head.substr(0, head.find("IDAT")).find("acTL") == std::string_view::npos;
}

void say(const std::string& what, const std::string& value) {
  std::printf("%-20s%s\n", what.c_str(), value.c_str());
}

template <class... Values>
std::string formatted(const char* form, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, form, values...);
  return text;
}

std::string sizeText(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

std::string psnrText(double psnr) { return std::isinf(psnr) ? "infinite" : formatted("%.2f dB", psnr); }

void sayDifference(const ImageDifference& difference, const DifferenceTolerance& tolerance) {
  const auto& [pixelsOff, window, shift, largest, psnr, ssim] = difference;
  say("pixels off", formatted("%.3g%% by more than %d levels (%.3g%% may be)", 100 * pixelsOff,
                              tolerance.level, 100 * tolerance.pixelsOff));
  const int side = DifferenceTolerance::kWindow;
  say(formatted("worst %dx%d window", side, side),
      window.value > 0 ? formatted("%.3g%% of it off, at (%d, %d) (%.3g%% may be)", 100 * window.value,
                                   window.x, window.y, 100 * tolerance.windowOff)
                       : "nothing off");
  say("shift of a window", shift.value > 0 ? formatted("%.2f levels, at (%d, %d) (%.2f may be)", shift.value,
                                                       shift.x, shift.y, tolerance.windowShift)
                                           : "none");
  say("largest difference",
      largest > 0 ? std::to_string(largest) + (largest > 1 ? " levels" : " level") : "none: they are equal");
  say("PSNR", psnrText(psnr));
  say("SSIM", formatted("%.5f", ssim));
}

/// The last line, and the exit status.
int sayVerdict(const std::vector<std::string>& reasons) {
  if (reasons.empty()) {
    std::printf("within the tolerance\n");
    return static_cast<int>(ExitStatus::ok);
  }
  std::string text;
  for (const std::string& reason : reasons) text += (text.empty() ? "" : "; ") + reason;
  std::printf("they differ: %s\n", text.c_str());
  return static_cast<int>(ExitStatus::imagesDiffer);
}

int sayOtherSize(const DiffOptions& options, const std::string& a, const std::string& b) {
  say("size", a + " and " + b);
  if (!options.output.empty()) say(options.output, "not written: there is no difference of two sizes");
  return sayVerdict({"the size is " + a + " against " + b + " pixels"});
}

Metadata metadataOf(const DiffOptions& options) {
  return {{"title", "Difference of " + fs::path(options.a).filename().string() + " and " +
                        fs::path(options.b).filename().string()},
          {"program", "smokebox " + programVersion()}};
}

/// What is wrong with the name of the output, before anything is compared.
void checkOutput(const DiffOptions& options, bool pictures) {
  if (options.output.empty()) return;
  const OutputKind kind = outputKind(options.output);
  if (kind == OutputKind::y4m) throw UsageError("-o -: standard output has the words; name a file");
  if (pictures && kind != OutputKind::pngStill)
    throw UsageError("-o " + options.output + ": two pictures differ by a picture; name a .png");
  // Absolute first: what is not there, such as a pattern, keeps the spelling of a relative name.
  std::error_code error;
  const auto plain = [&](const std::string& file) {
    return fs::weakly_canonical(fs::absolute(file, error), error);
  };
  for (const std::string& input : {options.a, options.b})
    if (plain(options.output) == plain(input) && !error)
      throw UsageError("-o " + options.output + ": is one of the two that are compared");
  if (!options.replace) refuseExisting(options.output);
}

int diffPictures(const DiffOptions& options, const DifferenceTolerance& tolerance) {
  const Image a = readPng(options.a), b = readPng(options.b);
  if (a.width != b.width || a.height != b.height)
    return sayOtherSize(options, sizeText(a.width, a.height), sizeText(b.width, b.height));
  const ImageDifference difference = measureDifference(a, b, tolerance);
  throwIfInterrupted();
  if (!options.output.empty())
    writePng(options.output, differencePicture(a, b, tolerance), metadataOf(options));
  say("size", sizeText(a.width, a.height));
  sayDifference(difference, tolerance);
  std::vector<std::string> reasons;
  if (!difference.within(tolerance)) reasons.push_back(difference.whatBreaks(tolerance));
  return sayVerdict(reasons);
}

/// The film of the differences; nothing if a still or nothing is asked for.
std::unique_ptr<FrameSink> openFilm(const DiffOptions& options, const FilmReader& film, double fps) {
  if (options.output.empty()) return nullptr;
  const OutputKind kind = outputKind(options.output);
  if (kind == OutputKind::pngStill) return nullptr;
  if (kind == OutputKind::mp4 && (film.width() % 2 || film.height() % 2))
    throw UsageError("-o " + options.output + ": " + sizeText(film.width(), film.height()) +
                     ": H.264 needs even width and height; name a .mkv");
  const int rate = fps > 0 ? std::max(1, static_cast<int>(std::lround(fps))) : kDefaultFps;
  return openSink(options.output, {film.width(), film.height(), rate, metadataOf(options)});
}

std::string rateText(double fps) { return formatted("%.6g frames/s", fps); }

/// "34 (1.133 s)".
std::string frameText(long frame, double fps) {
  return std::to_string(frame) + (fps > 0 ? formatted(" (%.3f s)", frame / fps) : "");
}

std::string countText(long count) { return std::to_string(count) + (count == 1 ? " frame" : " frames"); }

void sayFilm(const FilmDifference& film, const DifferenceTolerance& tolerance, double fps) {
  say("out of tolerance",
      film.first ? formatted("%ld of %s, the first is %s", film.outside, countText(film.compared).c_str(),
                             frameText(*film.first, fps).c_str())
                 : "none of " + countText(film.compared));
  say("PSNR of the film", psnrText(film.psnr));
  say("SSIM of the film", formatted("%.5f", film.ssim));
  say("worst frame", frameText(film.worst.number, fps));
  sayDifference(film.worst.difference, tolerance);
}

int diffFilms(const DiffOptions& options, const DifferenceTolerance& tolerance) {
  FilmReader a(options.a), b(options.b);
  if (a.width() != b.width() || a.height() != b.height())
    return sayOtherSize(options, sizeText(a.width(), a.height()), sizeText(b.width(), b.height()));
  const double fps = a.fps() > 0 ? a.fps() : b.fps();
  const std::unique_ptr<FrameSink> sink = openFilm(options, a, fps);
  const FilmDifference film = measureFilms(a, b, tolerance, [&](const ComparedFrame& frame) {
    if (sink) sink->add(differencePicture(frame.a, frame.b, tolerance, false), frame.number);
  });
  if (film.compared == 0)
    throw IoError((film.framesA == 0 ? options.a : options.b) + ": there is no frame in it");
  throwIfInterrupted();
  if (sink)
    sink->finish();
  else if (!options.output.empty())
    writePng(options.output, differencePicture(film.worst.a, film.worst.b, tolerance), metadataOf(options));

  std::vector<std::string> reasons;
  say("size", sizeText(a.width(), a.height()));
  std::string frames = std::to_string(film.framesA), rate = rateText(fps);
  if (film.framesA != film.framesB) {
    frames += " and " + std::to_string(film.framesB);
    reasons.push_back(countText(film.framesA) + " against " + std::to_string(film.framesB));
  }
  // A folder of pictures goes with any rate.
  if (a.fps() > 0 && b.fps() > 0 && std::fabs(a.fps() - b.fps()) > kSameRate * a.fps()) {
    rate += " and " + rateText(b.fps());
    reasons.push_back(rateText(a.fps()) + " against " + rateText(b.fps()));
  }
  say("frames", frames);
  if (fps > 0) say("frame rate", rate);
  sayFilm(film, tolerance, fps);
  if (film.outside > 0)
    reasons.push_back(std::to_string(film.outside) + " of " + countText(film.compared) +
                      (film.outside == 1 ? " is" : " are") + " out of tolerance, the worst is " +
                      std::to_string(film.worst.number) + ": " + film.worst.difference.whatBreaks(tolerance));
  return sayVerdict(reasons);
}

}  // namespace

int runDiff(const DiffOptions& options) {
  catchInterrupts();
  if (!options.output.empty()) outputKind(options.output);  // throws if the ending is unknown
  const bool pictureA = isPicture(options.a), pictureB = isPicture(options.b);
  if (pictureA != pictureB)
    throw UsageError((pictureA ? options.a : options.b) + " is a picture, and " +
                     (pictureA ? options.b : options.a) + " is a film; two of a kind can be compared");
  checkOutput(options, pictureA);
  const DifferenceTolerance tolerance;
  return pictureA ? diffPictures(options, tolerance) : diffFilms(options, tolerance);
}

}  // namespace smokebox
