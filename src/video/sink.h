// Where finished frames go: a film, a stream, a folder of PNGs, a still.
#pragma once
#include <filesystem>
#include <memory>

#include "image/image.h"
#include "image/png.h"

namespace smokebox {

struct FilmFormat {
  int width = 0, height = 0;
  int fps = 30;
  Metadata metadata;  // title, scene, hash, version
};

/// Takes frames in order. Until finish() returns nothing stands under the final name; a sink that is
/// destroyed before removes what it has written beside it.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// `frame`: number of the frame in the film, from 0. Throws IoError or VideoError.
  virtual void add(const Image& image, long frame) = 0;
  virtual void finish() = 0;
};

/// What the ending of an `-o` asks for; throws UsageError (with the endings that there are) if it is unknown.
enum class OutputKind { mp4, mkv, y4m, pngSequence, pngStill };
OutputKind outputKind(const std::string& output);

/// Opens `output` (a path as given with -o). Throws UsageError, IoError, or VideoError (an odd size for
/// yuv420p, ...). Whether an existing file may be replaced is asked before, by refuseExisting().
std::unique_ptr<FrameSink> openSink(const std::string& output, const FilmFormat& format);
/// Throws IoError if `output` exists (for a sequence: if any frame of it does) and names -y.
void refuseExisting(const std::string& output);

}  // namespace smokebox
