#include "image/png.h"

#include <png.h>
#include <zlib.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "base/errors.h"
#include "base/part_file.h"

namespace smokebox {

namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

[[noreturn]] void fail(const std::filesystem::path& file, const char* doing, const std::string& why) {
  throw IoError("cannot " + std::string(doing) + " " + file.string() + ": " + why);
}

// libpng reports errors through a call that must not return. It is C, so no exception may cross it: the
// message is kept here, and a longjmp leads back to a frame that holds nothing to be destroyed.
struct Message {
  char text[256] = "";
};
[[noreturn]] void onError(png_structp png, png_const_charp message) {
  std::snprintf(static_cast<Message*>(png_get_error_ptr(png))->text, sizeof(Message::text), "%s", message);
  png_longjmp(png, 1);
}
void onWarning(png_structp, png_const_charp) {
}  // libpng's warnings concern odd chunks of foreign files, not pixels

/// Everything between png_create and png_destroy; false on an error, whose words are in `message`.
bool writeAll(std::FILE* file, const Image& image, png_textp texts, int textCount, Message& message) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &message, onError, onWarning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info || setjmp(png_jmpbuf(png))) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_init_io(png, file);
  png_set_IHDR(png, info, image.width, image.height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_compression_level(png, 1);
  png_set_compression_strategy(png, Z_RLE);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
  if (textCount > 0) png_set_text(png, info, texts, textCount);
  png_write_info(png, info);
  png_set_filler(png, 0, PNG_FILLER_AFTER);  // pictures are opaque: alpha is left out
  for (int row = 0; row < image.height; ++row)
    png_write_row(png, image.rgba.data() + std::size_t{4} * row * image.width);
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

/// What is read; plain memory, so that a longjmp past it is harmless: the owner is the caller.
struct Reading {
  Image image;
  Metadata metadata;
};

bool readAll(std::FILE* file, bool pixels, Reading& reading, Message& message) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message, onError, onWarning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info || setjmp(png_jmpbuf(png))) {
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_init_io(png, file);
  png_read_info(png, info);
  if (pixels) {
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    png_set_filler(png, 0xFF, PNG_FILLER_AFTER);
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    reading.image = Image(static_cast<int>(png_get_image_width(png, info)),
                          static_cast<int>(png_get_image_height(png, info)));
    for (int pass = 0; pass < passes; ++pass)
      for (int row = 0; row < reading.image.height; ++row)
        png_read_row(png, reading.image.rgba.data() + std::size_t{4} * row * reading.image.width, nullptr);
    png_read_end(png, info);
  }
  png_textp texts = nullptr;
  const int count = static_cast<int>(png_get_text(png, info, &texts, nullptr));
  for (int k = 0; k < count; ++k) reading.metadata.emplace_back(texts[k].key, texts[k].text);
  png_destroy_read_struct(&png, &info, nullptr);
  return true;
}

Reading read(const std::filesystem::path& path, bool pixels) {
  if (std::filesystem::is_directory(path)) fail(path, "read", "it is a folder");
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(path, "read", std::strerror(errno));
  unsigned char signature[8] = {};
  const std::size_t got = std::fread(signature, 1, sizeof signature, file.get());
  if (got != sizeof signature || png_sig_cmp(signature, 0, sizeof signature) != 0)
    fail(path, "read", "it is no PNG");
  std::rewind(file.get());
  Reading reading;
  Message message;
  if (!readAll(file.get(), pixels, reading, message)) fail(path, "read", message.text);
  return reading;
}

bool isAscii(const std::string& text) {
  for (const char c : text)
    if (static_cast<unsigned char>(c) >= 0x80) return false;
  return true;
}

}  // namespace

void writePng(const std::filesystem::path& path, const Image& image, const Metadata& metadata) {
  checkInvariant(
      image.width > 0 && image.height > 0 && image.rgba.size() == std::size_t{4} * image.width * image.height,
      "an image to be written has pixels for its size");
  std::vector<png_text> texts;
  for (const auto& [key, value] : metadata) {
    png_text text{};
    // Plain text where it will do; UTF-8 needs the international kind of chunk.
    text.compression = isAscii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    text.key = const_cast<png_charp>(key.c_str());
    text.text = const_cast<png_charp>(value.c_str());
    texts.push_back(text);
  }
  PartFile part(path);
  File file(std::fopen(part.path().c_str(), "wb"));
  if (!file) fail(path, "write", std::strerror(errno));
  Message message;
  errno = 0;
  if (!writeAll(file.get(), image, texts.data(), static_cast<int>(texts.size()), message))
    fail(path, "write", errno ? std::strerror(errno) : message.text);
  // A full disk shows only here.
  if (std::fflush(file.get()) != 0) fail(path, "write", std::strerror(errno));
  if (std::fclose(file.release()) != 0) fail(path, "write", std::strerror(errno));
  part.commit();
}

Image readPng(const std::filesystem::path& path) { return read(path, true).image; }

Metadata readPngMetadata(const std::filesystem::path& path) { return read(path, false).metadata; }

}  // namespace smokebox
