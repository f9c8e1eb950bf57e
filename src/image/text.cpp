#include "image/text.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/errors.h"

namespace smokebox {

namespace {
struct FreeLibrary {
  void operator()(FT_Library library) const { FT_Done_FreeType(library); }
};
struct FreeFace {
  void operator()(FT_Face face) const { FT_Done_Face(face); }
};

constexpr std::array<const char*, 3> kFontFolders = {
    "/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/dejavu-sans-fonts", "/usr/share/fonts/TTF"};

std::string fontFile(const char* name) {
  for (const char* folder : kFontFolders) {
    const std::filesystem::path file = std::filesystem::path(folder) / name;
    std::error_code ignored;  // "not there" is the answer
    if (std::filesystem::exists(file, ignored)) return file.string();
  }
  throw IoError(std::string("no font ") + name + ": install the package fonts-dejavu-core");
}

/// The code points of a UTF-8 text; what is no UTF-8 becomes U+FFFD, one for each bad byte.
std::vector<char32_t> decoded(std::string_view text) {
  std::vector<char32_t> points;
  for (std::size_t k = 0; k < text.size();) {
    const unsigned char lead = text[k];
    const int length = lead < 0x80                   ? 1
                       : lead >= 0xC2 && lead < 0xE0 ? 2
                       : lead >= 0xE0 && lead < 0xF0 ? 3
                       : lead >= 0xF0 && lead < 0xF5 ? 4
                                                     : 0;
    char32_t point = length == 1 ? lead : lead & (0x7F >> length);
    bool good = length > 0 && k + length <= text.size();
    for (int m = 1; good && m < length; ++m) {
      const unsigned char next = text[k + m];
      good = (next & 0xC0) == 0x80;
      point = point << 6 | (next & 0x3F);
    }
    constexpr char32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
    good = good && point >= kSmallest[length] && point <= 0x10FFFF && (point < 0xD800 || point > 0xDFFF);
    points.push_back(good ? point : 0xFFFD);
    k += good ? length : 1;
  }
  return points;
}
}  // namespace

struct TextPainter::Library {
  std::unique_ptr<FT_LibraryRec_, FreeLibrary> library;
  std::array<std::unique_ptr<FT_FaceRec_, FreeFace>, 2> faces;  // by FontWeight

  FT_Face face(FontWeight weight, int size) {
    const FT_Face chosen = faces[static_cast<int>(weight)].get();
    if (FT_Set_Pixel_Sizes(chosen, 0, std::max(size, 1)) != 0)
      throw IoError("the font cannot be scaled to " + std::to_string(size) + " pixels");
    return chosen;
  }

  /// Calls body(pen, slot) for each glyph, drawn or only measured; returns where the pen ends. Pixels.
  template <class Body>
  int run(std::string_view utf8, int size, FontWeight weight, FT_Int32 flags, Body&& body) {
    const FT_Face font = face(weight, size);
    FT_Pos pen = 0;  // 1/64 pixel
    FT_UInt last = 0;
    for (const char32_t point : decoded(utf8)) {
      const FT_UInt glyph = FT_Get_Char_Index(font, point);  // 0, the font's box, if it has none
      FT_Vector kerning{0, 0};
      if (last && glyph && FT_HAS_KERNING(font))
        FT_Get_Kerning(font, last, glyph, FT_KERNING_DEFAULT, &kerning);
      last = glyph;
      pen += kerning.x;
      if (FT_Load_Glyph(font, glyph, flags | FT_LOAD_TARGET_LIGHT) != 0)
        throw IoError("the font has a glyph that cannot be loaded");
      body(static_cast<int>((pen + 32) >> 6), font->glyph);
      pen += font->glyph->advance.x;
    }
    return static_cast<int>((pen + 32) >> 6);
  }
};

TextPainter::TextPainter() : library_(std::make_unique<Library>()) {
  FT_Library library = nullptr;
  if (FT_Init_FreeType(&library) != 0) throw IoError("FreeType cannot be started");
  library_->library.reset(library);
  const char* names[] = {"DejaVuSans.ttf", "DejaVuSans-Bold.ttf"};
  for (int k = 0; k < 2; ++k) {
    const std::string file = fontFile(names[k]);
    FT_Face face = nullptr;
    if (FT_New_Face(library, file.c_str(), 0, &face) != 0)
      throw IoError("cannot read the font " + file + ": is the package fonts-dejavu-core whole?");
    library_->faces[k].reset(face);
  }
}

TextPainter::~TextPainter() = default;

int TextPainter::advance(std::string_view utf8, int size, FontWeight weight) {
  return library_->run(utf8, size, weight, FT_LOAD_DEFAULT, [](int, FT_GlyphSlot) {});
}

TextMask TextPainter::line(std::string_view utf8, int size, FontWeight weight) {
  int left = 0, right = 0, above = 0, below = 0;
  const int end = library_->run(utf8, size, weight, FT_LOAD_RENDER, [&](int pen, FT_GlyphSlot slot) {
    left = std::min(left, pen + slot->bitmap_left);
    right = std::max(right, pen + slot->bitmap_left + static_cast<int>(slot->bitmap.width));
    above = std::max(above, slot->bitmap_top);
    below = std::max(below, static_cast<int>(slot->bitmap.rows) - slot->bitmap_top);
  });
  TextMask mask;
  mask.originX = -left;
  mask.baseline = above;
  mask.width = std::max(right, end) - left;
  mask.height = above + below;
  mask.coverage.assign(std::size_t(mask.width) * mask.height, 0);
  library_->run(utf8, size, weight, FT_LOAD_RENDER, [&](int pen, FT_GlyphSlot slot) {
    const FT_Bitmap& bitmap = slot->bitmap;
    for (unsigned row = 0; row < bitmap.rows; ++row) {
      const unsigned char* from = bitmap.buffer + static_cast<std::ptrdiff_t>(row) * bitmap.pitch;
      std::uint8_t* to = mask.coverage.data() +
                         std::size_t(mask.baseline - slot->bitmap_top + static_cast<int>(row)) * mask.width +
                         (pen + slot->bitmap_left - left);
      for (unsigned column = 0; column < bitmap.width; ++column)
        to[column] = std::max(to[column], from[column]);
    }
  });
  return mask;
}

std::vector<std::string> TextPainter::wrapped(std::string_view utf8, int size, FontWeight weight, int most) {
  std::vector<std::string> lines;
  std::size_t start = 0;
  while (start <= utf8.size()) {
    const std::size_t end = std::min(utf8.find('\n', start), utf8.size());
    std::string line;
    for (std::size_t at = start; at < end;) {
      const std::size_t space = std::min(utf8.find(' ', at), end);
      const std::string word(utf8.substr(at, space - at));
      at = space + 1;
      if (word.empty()) continue;
      const std::string longer = line.empty() ? word : line + " " + word;
      if (!line.empty() && advance(longer, size, weight) > most) {
        lines.push_back(line);
        line = word;
      } else {
        line = longer;
      }
    }
    if (!line.empty()) lines.push_back(line);
    start = end + 1;
  }
  return lines;
}

}  // namespace smokebox
