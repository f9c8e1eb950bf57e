// Lines of text as coverage masks, by FreeType with the DejaVu Sans fonts. UTF-8, kerned, lightly hinted; a
// character that the font lacks becomes a box. Left to right only, no shaping of joined scripts.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace smokebox {

/// One line of text. The pen starts at column `originX`, on the baseline, row `baseline`.
struct TextMask {
  int width = 0, height = 0;
  int originX = 0, baseline = 0;
  std::vector<std::uint8_t> coverage;  // width * height, top row first
};

enum class FontWeight { regular, bold };

class TextPainter {
 public:
  /// Throws IoError, naming the package, if the fonts are not there.
  TextPainter();
  ~TextPainter();
  TextPainter(const TextPainter&) = delete;
  TextPainter& operator=(const TextPainter&) = delete;

  /// `size`: pixels of an em, at least 1.
  TextMask line(std::string_view utf8, int size, FontWeight weight = FontWeight::regular);
  /// How far the pen moves, pixels.
  int advance(std::string_view utf8, int size, FontWeight weight = FontWeight::regular);
  /// Broken at spaces (and at line ends in the text) so that no line is wider than `most` pixels, but for
  /// words that are.
  std::vector<std::string> wrapped(std::string_view utf8, int size, FontWeight weight, int most);

 private:
  struct Library;
  std::unique_ptr<Library> library_;
};

}  // namespace smokebox
