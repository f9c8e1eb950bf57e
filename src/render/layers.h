// The layers that a picture is painted from; each draws itself from a snapshot with its own shaders.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "image/colormap.h"
#include "image/text.h"
#include "render/batches.h"
#include "render/encoded_lattice.h"
#include "render/gl_objects.h"
#include "render/mask.h"
#include "render/picture_frame.h"
#include "render/smooth_field.h"
#include "render/strokes.h"
#include "world/snapshot.h"

namespace smokebox {

/// What all layers share: OpenGL, the batches, fonts.
struct Palette {
  const Gl& gl;
  int width, height;  // of the picture, pixels
  SpriteBatch sprites;
  PanelBatch panels;
  StrokeBatch strokes;
  TextPainter text;

  Palette(const Gl& functions, int pictureWidth, int pictureHeight)
      : gl(functions),
        width(pictureWidth),
        height(pictureHeight),
        sprites(functions, pictureWidth, pictureHeight),
        panels(functions, pictureWidth, pictureHeight),
        strokes(functions, pictureWidth, pictureHeight) {}
};

/// Smoke of any number of colours.
class SmokeLayer {
 public:
  SmokeLayer(const Gl& gl, GlTarget& target);
  /// `onGround`: nothing is drawn below it yet, so that the whole picture is filled with finished colours.
  void draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame, bool onGround);

 private:
  void gather(const Snapshot& snapshot, const LatticeWindow& window);
  void fillClosedCells();
  void chooseTiles(const Grid& grid, const LatticeWindow& window, const PictureFrame& frame);
  void drawBlended(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);
  void drawOnGround(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);

  GlProgram oneColor_, manyColors_;
  GlTexture density_, colors_;
  GlInstances tiles_;
  EncodedLattice encoded_;
  SrgbEncoder encoder_;
  std::vector<std::uint32_t> finished_;  // colours of the samples of the lattice, on the ground
  Lattice lattice_, scratch_;
  std::vector<float> openShare_;  // of the samples of the lattice
  std::vector<int> unreached_;    // closed samples without an open neighbour
  std::vector<PictureTile> smoky_;
  std::vector<float> records_;
};

/// A scalar field in colours: pressure, vorticity or speed. The colours are looked up for the samples of the
/// refined lattice, which are finer than two pixels, and not for each pixel: evaluating the map there would
/// double the frame.
class FieldLayer {
 public:
  FieldLayer(const Gl& gl, GlTarget& target);
  /// `onGround`: as above; the layer must be opaque.
  void draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame, bool onGround);

 private:
  void gather(const Snapshot& snapshot, LayerKind kind, const PictureFrame& frame);
  /// Colours of the lattice's samples, in the form that `make` gives them.
  template <class Value, class Make>
  void color(const ColorMap& map, const std::array<double, 2>& range, std::vector<Value>& colors,
             Make&& make);

  GlProgram program_;
  GlTexture texture_;
  GlInstances quad_;
  EncodedLattice encoded_;
  SrgbEncoder encoder_;
  Lattice lattice_, scratch_;
  std::vector<LinearColor> colors_;      // of the lattice's samples, to be blended
  std::vector<std::uint32_t> finished_;  // the same, ready for the file
  std::vector<float> records_;
};

/// How a field is shown: its colours, the range for the film, its name with the unit.
struct FieldStyle {
  const ColorMap& map;
  std::array<double, 2> range;
  std::string label;
};
FieldStyle fieldStyle(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);
/// Does the snapshot have what this field layer needs?
bool hasField(const Snapshot& snapshot, LayerKind kind);
/// Sets the uniforms of shaders/colormap.glsl.
void setColorMap(const GlProgram& program, const ColorMap& map, const std::array<double, 2>& range);

/// Solids as filled shapes with an outline. Their masks are kept until shape, pose or camera change.
class SolidsLayer {
 public:
  explicit SolidsLayer(Palette& palette);
  void draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);

 private:
  struct Kept {
    PixelOutlines outlines;
    Mask mask;
  };
  Palette& palette_;
  MaskPainter painter_;
  std::vector<Kept> kept_;
  PixelOutlines pixels_;
};

/// The velocity as evenly spaced arrows.
class ArrowsLayer {
 public:
  explicit ArrowsLayer(const Gl& gl);
  void draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);

 private:
  GlProgram program_;
  GlInstances instances_;
  std::vector<float> records_;
};

/// Colour bars of the fields that are shown, side by side at the right.
class ColorBarLayer {
 public:
  explicit ColorBarLayer(Palette& palette);
  void draw(const Snapshot& snapshot, const std::vector<const LayerSpec*>& fields, const PictureFrame& frame);

 private:
  Palette& palette_;
  GlProgram program_;
  GlInstances quad_;
};

/// A line of text with a halo, ready for the sprite batch; the pen starts at (x, baseline). Cut to the
/// picture.
Mask haloedText(TextPainter& text, const std::string& utf8, int size, FontWeight weight, int x, int baseline,
                int halo, int pictureWidth, int pictureHeight);
/// The size in pixels of a font of `units` (1/720 of the picture's height), never too small to be read.
int fontSize(const PictureFrame& frame, double units);

/// Captions at the bottom, or at the top, and the time at the top left.
class TextLayer {
 public:
  explicit TextLayer(Palette& palette) : palette_(palette) {}
  void drawCaptions(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);
  void drawTime(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);

 private:
  Palette& palette_;
  std::vector<std::string> keptCaptions_;
  bool keptAtTop_ = false;
  struct CaptionLine {
    Mask mask;
    int width;
  };
  std::vector<CaptionLine> lines_;
  int lineHeight_ = 0, ascent_ = 0, descent_ = 0;
  std::string keptTime_;
  Mask timeMask_;
  int timeWidth_ = 0;
};

/// Points and regions that are measured, with their names.
class ProbesLayer {
 public:
  explicit ProbesLayer(Palette& palette);
  void draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);

 private:
  Palette& palette_;
  MaskPainter painter_;
  PixelOutlines pixels_;
};

}  // namespace smokebox
