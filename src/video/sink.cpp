#include "video/sink.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <system_error>

#include "base/errors.h"
#include "video/film_sink.h"
#include "video/png_sinks.h"
#include "video/y4m_sink.h"

namespace smokebox {
namespace fs = std::filesystem;

OutputKind outputKind(const std::string& output) {
  if (output == "-") return OutputKind::y4m;
  std::string ending = fs::path(output).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (ending == ".mp4") return OutputKind::mp4;
  if (ending == ".mkv") return OutputKind::mkv;
  if (ending == ".png") return FramePattern::parse(output) ? OutputKind::pngSequence : OutputKind::pngStill;
  throw UsageError(
      "-o " + output + ": " + (ending.empty() ? "no ending" : "unknown ending '" + ending + "'") +
      "; there are .mp4, .mkv, .png (a still), folder/%05d.png (frames) and - (Y4M on standard output)");
}

std::unique_ptr<FrameSink> openSink(const std::string& output, const FilmFormat& format) {
  switch (outputKind(output)) {
    case OutputKind::mp4:
      return std::make_unique<FilmSink>(output, format, FilmSink::Codec::h264);
    case OutputKind::mkv:
      return std::make_unique<FilmSink>(output, format, FilmSink::Codec::ffv1);
    case OutputKind::pngSequence:
      return std::make_unique<PngSequenceSink>(*FramePattern::parse(output), format);
    case OutputKind::pngStill:
      return std::make_unique<PngStillSink>(output, format);
    case OutputKind::y4m:
      break;
  }
  if (::isatty(STDOUT_FILENO))
    throw UsageError("-o -: standard output is a terminal; send it into a program or a file");
  return std::make_unique<Y4mSink>(STDOUT_FILENO, "standard output", format);
}

void refuseExisting(const std::string& output) {
  const OutputKind kind = outputKind(output);
  if (kind == OutputKind::y4m) return;
  std::error_code error;
  if (kind != OutputKind::pngSequence) {
    // A device or a pipe takes what comes: nothing is lost by writing to it.
    if (fs::is_regular_file(output, error)) throw IoError(output + ": is there already; -y replaces it");
    return;
  }
  const FramePattern pattern = *FramePattern::parse(output);
  for (fs::directory_iterator entry(pattern.folder.empty() ? fs::path(".") : pattern.folder, error), end;
       !error && entry != end; entry.increment(error))
    if (pattern.matches(entry->path().filename().string()))
      throw IoError(entry->path().string() + ": is there already; -y replaces it");
}

}  // namespace smokebox
