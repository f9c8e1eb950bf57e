// Draws a row of the table with the program itself, as a user would.
#pragma once
#include <string>
#include <vector>

#include "golden/set/golden_table.h"
#include "image/image.h"
#include "render/gl_backend.h"

namespace smokebox::golden {

/// How a row is drawn.
struct Variant {
  GlBackend backend = defaultGlBackend();
  int threads = 2;
  /// "osmesa-2-threads".
  std::string name() const;
};

/// The pictures of a row, one for each of its times. `more`: settings laid over those of the row. Throws
/// std::runtime_error with what the program said if it fails.
std::vector<Image> draw(const Row& row, const Variant& variant, const std::vector<std::string>& more = {});

}  // namespace smokebox::golden
