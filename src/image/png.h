// PNG files by libpng.
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "image/image.h"

namespace smokebox {

/// Written as text chunks, in this order. No clock time goes in: a second run gives the same bytes.
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// Writes beside the file (`<name>.part`) and renames. Throws IoError (also for a full disk).
void writePng(const std::filesystem::path& file, const Image& image, const Metadata& metadata);
/// Throws IoError if it cannot be read or is no PNG.
Image readPng(const std::filesystem::path& file);
/// The text chunks of a PNG.
Metadata readPngMetadata(const std::filesystem::path& file);

}  // namespace smokebox
