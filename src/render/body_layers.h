// The layers of what moves by itself: bodies, particles, springs, joints, cloth, where they have been and
// where they meet. None owns anything of OpenGL before it has drawn something.
#pragma once
#include <optional>
#include <vector>

#include "render/body_mark.h"
#include "render/layers.h"

namespace smokebox {

/// Filled shapes with a darker outline (a lighter one on what is nearly black), and a spoke that turns with
/// them. Masks are kept until a shape moves.
class BodiesLayer {
 public:
  explicit BodiesLayer(Palette& palette);
  void draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);

 private:
  void drawDisk(const BodyPicture& body, const LayerSpec& layer, const PictureFrame& frame);
  void drawOutlines(const BodyPicture& body, std::size_t place, const LayerSpec& layer,
                    const PictureFrame& frame);

  struct Kept {
    PixelOutlines outlines;
    Mask mask;
    bool marked = false;
    int index = -1;                // of the body that the mark is of
    std::optional<BodyMark> mark;  // in the body's own coordinates
  };
  std::optional<Spoke> spokeOf(const BodyPicture& body, Kept& kept, double stroke,
                               const PictureFrame& frame) const;

  Palette& palette_;
  MaskPainter painter_;
  std::vector<Kept> kept_;  // by their place in the snapshot
  PixelOutlines pixels_;
};

/// Small disks.
class ParticlesLayer {
 public:
  explicit ParticlesLayer(Palette& palette) : palette_(palette) {}
  void draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);

 private:
  Palette& palette_;
};

/// Zigzags in the colour of their tension, blue where pressed and red where they pull; an event's pull as a
/// line with a ring at its end.
class SpringsLayer {
 public:
  explicit SpringsLayer(Palette& palette) : palette_(palette) {}
  void draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);

 private:
  void addPull(const SpringPicture& spring, const Color& ink, const LayerSpec& layer,
               const PictureFrame& frame);

  Palette& palette_;
  std::optional<GlProgram> program_;
  std::optional<GlInstances> instances_;
  std::vector<float> records_;
};

/// Pins as rings, welds as crossed squares, slides as rails with a slider, ropes as they hang, motors as
/// arrows.
class JointsLayer {
 public:
  explicit JointsLayer(Palette& palette) : palette_(palette) {}
  void draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);

 private:
  struct Ink {
    LinearColor line, ground, halo;
  };
  void addPin(const JointPicture& joint, const Ink& ink, const PictureFrame& frame);
  void addWeld(const JointPicture& joint, const Ink& ink, const PictureFrame& frame);
  void addSlide(const JointPicture& joint, const Ink& ink, const PictureFrame& frame);
  void addRope(const JointPicture& joint, const Ink& ink, const PictureFrame& frame);

  Palette& palette_;
};

/// A surface that is shaded by how it is stretched and turned, with a hem along its rim and its holes.
class ClothLayer {
 public:
  explicit ClothLayer(Palette& palette) : palette_(palette) {}
  void draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);

 private:
  void drawCells(const ClothPicture& cloth, const Color& color, double opacity);
  void drawLines(const ClothPicture& cloth, const Color& color, double opacity, const PictureFrame& frame);

  Palette& palette_;
  std::optional<GlProgram> program_;
  std::optional<GlInstances> instances_;
  std::vector<float> records_;
  std::vector<Vec2> pixels_;
};

/// Lines that taper and fade towards where things were longest ago.
class TrailsLayer {
 public:
  explicit TrailsLayer(Palette& palette) : palette_(palette) {}
  void draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);

 private:
  Palette& palette_;
  std::vector<Vec2> points_;
  std::vector<StrokeBatch::Look> looks_;
};

/// Places and directions of blows, the larger the stronger, fading; a small dot where things rest.
class CollisionsLayer {
 public:
  explicit CollisionsLayer(Palette& palette) : palette_(palette) {}
  void draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame);

 private:
  Palette& palette_;
};

}  // namespace smokebox
