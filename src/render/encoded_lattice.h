// The lowest layer of a picture: a lattice whose samples are finished colours, 8-bit sRGB as they go into the
// file. It is interpolated here and copied into the target, for a software OpenGL takes three times as long
// for the same pixels; and colours are worked out once a sample, not once a pixel.
// Limits: colours between samples, which are less than two pixels apart, are mixed as they are encoded.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "render/batches.h"
#include "render/gl_objects.h"
#include "render/picture_frame.h"
#include "render/smooth_field.h"

namespace smokebox {

/// From linear light, 0 to 1, to 8-bit sRGB, by a table over the root of the light, which is nearly even in
/// sRGB: within 0.05 of a level before rounding.
class SrgbEncoder {
 public:
  static constexpr int kSteps = 4096;
  SrgbEncoder();
  /// `root`: of the light, times kSteps, rounded.
  std::uint32_t atRoot(int root) const { return bytes_[root]; }
  /// R, G, B, 255 in the order of memory.
  std::uint32_t packed(const LinearColor& color) const;

 private:
  std::array<std::uint32_t, kSteps + 1> bytes_;
};

/// A part of the picture, pixels.
struct PictureTile {
  double x0, y0, x1, y1;
};

/// The texture's coordinates of tiles of the picture, for smoke.vert: pixels, then coordinates.
void appendTiles(const std::vector<PictureTile>& tiles, const Lattice& lattice, const GlTexture& texture,
                 const PictureFrame& frame, std::vector<float>& records);

class EncodedLattice {
 public:
  explicit EncodedLattice(GlTarget& target) : target_(target) {}
  /// Fills the whole target: `ground`, and over it the tiles from `colors`, one for each sample of
  /// `lattice` (whose values are not looked at).
  void draw(std::uint32_t ground, const std::vector<std::uint32_t>& colors, const Lattice& lattice,
            const std::vector<PictureTile>& tiles, const PictureFrame& frame);

 private:
  /// Between which two samples pixels lie along x or y, and how far along, of kUnit.
  struct Places {
    std::vector<int> sample;
    std::vector<std::uint32_t> share;
  };
  static void place(Places& places, int first, int past, double atFirst, double step, int samples);
  void paint(const PictureTile& tile, const std::vector<std::uint32_t>& colors, const Lattice& lattice,
             const PictureFrame& frame);
  void spread(const std::uint32_t* samples, int next, int width, std::uint32_t* redBlue,
              std::uint32_t* green) const;

  GlTarget& target_;
  Places columns_, rows_;
  std::array<std::vector<std::uint32_t>, 2> spread_;  // of two neighbouring rows: red and blue, then green
  std::vector<std::uint32_t> pixels_;
};

}  // namespace smokebox
