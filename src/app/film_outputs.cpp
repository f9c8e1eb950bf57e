#include "app/film_outputs.h"

#include <cstdio>
#include <filesystem>
#include <system_error>

#include "base/errors.h"
#include "video/sink.h"

namespace smokebox {

std::string inRenders(const std::string& file) {
  std::error_code error;
  std::filesystem::create_directories("renders", error);
  if (error) throw IoError("renders: cannot make this folder: " + error.message());
  return "renders/" + file;
}

void refuseOddSize(const std::vector<std::string>& outputs, int width, int height) {
  for (const std::string& output : outputs)
    if (outputKind(output) == OutputKind::mp4 && (width % 2 || height % 2))
      throw UsageError(output + ": " + std::to_string(width) + "x" + std::to_string(height) +
                       ": H.264 needs even width and height; try --size " +
                       std::to_string(width + width % 2) + "x" + std::to_string(height + height % 2) +
                       ", or .mkv");
}

void tellDone(const std::vector<std::string>& outputs, long frames, double seconds) {
  std::string names;
  for (const std::string& output : outputs)
    names += (names.empty() ? "" : ", ") + (output == "-" ? "standard output" : output);
  std::fprintf(stderr, "%s: %ld frame%s in %.1f s (%.1f frames/s)\n", names.c_str(), frames,
               frames == 1 ? "" : "s", seconds, static_cast<double>(frames) / seconds);
}

}  // namespace smokebox
