// Whole pictures, drawn through OpenGL.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ostream>

#include "base/errors.h"
#include "base/maths.h"
#include "image/colormap.h"
#include "render/renderer.h"
#include "support/print_backend.h"

namespace smokebox {
namespace {

struct Rgb {
  int r, g, b;
  bool operator==(const Rgb&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Rgb& c) { return out << c.r << "," << c.g << "," << c.b; }

Rgb at(const Image& image, int x, int y) {
  const std::uint8_t* p = image.rgba.data() + 4 * (std::size_t(y) * image.width + x);
  return {p[0], p[1], p[2]};
}
Rgb rgb(const Color& c) {
  return {int(std::lround(c.r * 255)), int(std::lround(c.g * 255)), int(std::lround(c.b * 255))};
}
int difference(const Rgb& a, const Rgb& b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}
double linearOf(int value) {
  const double c = value / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

Outline circle(Vec2 centre, double radius) {
  Outline outline;
  for (int k = 0; k < 256; ++k)
    outline.push_back(centre +
                      Vec2{radius * std::cos(2 * kPi * k / 256), radius * std::sin(2 * kPi * k / 256)});
  return outline;
}

Snapshot scene(int nx, int ny, double width, std::initializer_list<LayerKind> kinds) {
  Snapshot snapshot;
  snapshot.grid = {nx, ny, width / nx};
  snapshot.open = Field(nx, ny, 1);
  for (const LayerKind kind : kinds) {
    LayerSpec layer;
    layer.kind = kind;
    layer.bar = false;
    snapshot.view.layers.push_back(layer);
  }
  return snapshot;
}

void addCircle(Snapshot& snapshot, Vec2 centre, double radius, const Color& color) {
  SolidPicture solid;
  solid.name = "circle";
  solid.outlines = {circle(centre, radius)};
  solid.pose.position = centre;
  solid.color = color;
  snapshot.solids.push_back(std::move(solid));
}

/// Each truth holds on each way to OpenGL that is built.
class RenderPicture : public testing::TestWithParam<GlBackend> {
 protected:
  RenderPicture() { preferDrawingAlone(); }  // as the program does

  static Image drawn(const Snapshot& snapshot, int width, int height) {
    Image image;
    Renderer(width, height, GetParam()).draw(snapshot, image);
    return image;
  }
};
INSTANTIATE_TEST_SUITE_P(Gl, RenderPicture, testing::ValuesIn(builtGlBackends()),
                         [](const auto& instance) { return std::string(nameOf(instance.param)); });

TEST_P(RenderPicture, EmptySceneIsTheGroundExactly) {
  // Every pixel has the scene's background, dark or light, and full alpha.
  for (const Color ground :
       {Color{0.055f, 0.063f, 0.078f}, Color{0.96f, 0.96f, 0.95f}, Color{0.2f, 0.4f, 0.6f}}) {
    Snapshot snapshot = scene(32, 18, 16, {LayerKind::smoke, LayerKind::solids, LayerKind::caption});
    snapshot.smoke.push_back({{1, 1, 1}, Field(32, 18)});
    snapshot.view.background = ground;
    const Image image = drawn(snapshot, 160, 90);
    for (int y = 0; y < 90; ++y)
      for (int x = 0; x < 160; ++x) ASSERT_EQ(at(image, x, y), rgb(ground)) << x << " " << y;
    EXPECT_EQ(image.rgba[3], 255);
  }
}

TEST_P(RenderPicture, SolidHasItsTrueAreaAndAspect) {
  // A circle covers its area within 0.5%, and is as wide as high within a pixel, whatever the picture's
  // shape.
  for (const auto& [w, h] : {std::pair{640, 360}, {501, 433}}) {
    Snapshot snapshot = scene(64, 36, 4, {LayerKind::solids});
    addCircle(snapshot, {1.93, 1.11}, 0.8, {1, 1, 1});  // its outline is white too
    snapshot.view.background = {0, 0, 0};
    const Image image = drawn(snapshot, w, h);
    const double scale = std::min(w / 4.0, h / 2.25);
    double area = 0;
    int left = w, right = 0, top = h, bottom = 0;
    // The frame of the letterbox lies outside of the domain: look within it only.
    const int y0 = static_cast<int>(std::ceil((h - 2.25 * scale) / 2)),
              x0 = static_cast<int>(std::ceil((w - 4 * scale) / 2));
    for (int y = y0; y < h - y0; ++y)
      for (int x = x0; x < w - x0; ++x) {
        const double share = linearOf(at(image, x, y).g);
        area += share;
        if (share < 0.5) continue;
        left = std::min(left, x), right = std::max(right, x);
        top = std::min(top, y), bottom = std::max(bottom, y);
      }
    const double truth = kPi * 0.64 * scale * scale;
    EXPECT_NEAR(area, truth, 0.005 * truth);
    EXPECT_NEAR(right - left, bottom - top, 1);
    EXPECT_NEAR(right - left + 1, 1.6 * scale, 1);
    // y goes up in the world: the centre, 0.015 below the middle, is below it in the picture.
    EXPECT_NEAR((top + bottom + 1) / 2.0, h / 2.0 + 0.015 * scale, 0.6);
  }
}

TEST_P(RenderPicture, SymmetricSceneIsSymmetric) {
  // Mirrored smoke and solids give a mirrored picture, within one step of a colour.
  Snapshot snapshot = scene(64, 36, 4, {LayerKind::smoke, LayerKind::solids});
  Field value(64, 36);
  for (int j = 0; j < 36; ++j)
    for (int i = 0; i < 64; ++i) {
      const double x = (i + 0.5 - 32) / 10, y = (j + 0.5 - 18) / 8;
      value(i, j) = static_cast<float>(std::exp(-x * x - y * y) * (1 + std::cos(5 * x) * std::cos(4 * y)));
    }
  snapshot.smoke.push_back({{1, 0.7f, 0.3f}, value});
  snapshot.smoke.push_back({{0.3f, 0.7f, 1}, value});
  addCircle(snapshot, {2, 1.125}, 0.3, {0.4f, 0.5f, 0.6f});
  const Image image = drawn(snapshot, 640, 360);
  for (int y = 0; y < 360; ++y)
    for (int x = 0; x < 320; ++x) {
      ASSERT_LE(difference(at(image, x, y), at(image, 639 - x, y)), 1) << x << " " << y;
      ASSERT_LE(difference(at(image, x, y), at(image, x, 359 - y)), 1) << x << " " << y;
    }
}

TEST_P(RenderPicture, NoHaloAlongSolids) {
  // Uniform smoke has one colour up to the edge of a solid, though the cells inside hold none.
  for (const int colors : {1, 2}) {
    Snapshot snapshot = scene(64, 36, 4, {LayerKind::smoke, LayerKind::solids});
    for (int c = 0; c < colors; ++c) snapshot.smoke.push_back({{1, 0.6f, 0.2f}, Field(64, 36, 0.5f)});
    const Vec2 centre{2, 1.125};
    const double radius = 0.5;
    for (int j = 0; j < 36; ++j)
      for (int i = 0; i < 64; ++i)
        if (length(snapshot.grid.cellCentre(i, j) - centre) < radius) {
          snapshot.open(i, j) = 0;
          for (SmokePicture& smoke : snapshot.smoke) smoke.value(i, j) = 0;
        }
    addCircle(snapshot, centre, radius, {1, 1, 1});
    const Image image = drawn(snapshot, 1280, 720);
    const Rgb far = at(image, 20, 20);
    EXPECT_GT(far.r, 100);
    for (int y = 0; y < 720; ++y)
      for (int x = 0; x < 1280; ++x) {
        if (std::hypot(x + 0.5 - 640, y + 0.5 - 360) < radius * 320 + 1.5) continue;
        ASSERT_LE(difference(at(image, x, y), far), 1) << x << " " << y;
      }
  }
}

TEST_P(RenderPicture, SmokeIsNeverBlocky) {
  // Cells of 20 pixels: between neighbouring pixels no colour jumps, and the way from full to empty takes
  // cells.
  Snapshot snapshot = scene(64, 36, 4, {LayerKind::smoke});
  Field value(64, 36);
  for (int j = 0; j < 36; ++j)
    for (int i = 0; i < 32; ++i) value(i, j) = 1;
  snapshot.smoke.push_back({{1, 1, 1}, value});
  const Image image = drawn(snapshot, 1280, 720);
  for (int x = 1; x < 1280; ++x) ASSERT_LE(difference(at(image, x, 360), at(image, x - 1, 360)), 12) << x;
  EXPECT_GT(at(image, 600, 360).g, at(image, 640, 360).g + 10);
  EXPECT_GT(at(image, 640, 360).g, at(image, 670, 360).g + 10);
}

TEST_P(RenderPicture, GroundShowsUnchangedBesideSmoke) {
  // Where smoke ends, the ground keeps its exact colour, whether smoke is drawn first or over something else.
  for (const bool first : {true, false}) {
    Snapshot snapshot = scene(64, 36, 4, {LayerKind::smoke});
    if (!first) {
      snapshot.view.layers.insert(snapshot.view.layers.begin(), LayerSpec{});
      snapshot.view.layers.front().kind = LayerKind::probes;
    }
    snapshot.smoke.push_back({{1, 1, 1}, Field(64, 36)});
    for (int j = 0; j < 36; ++j) snapshot.smoke[0].value(32, j) = 1;
    const Image image = drawn(snapshot, 640, 360);
    for (int x = 0; x < 640; ++x)
      ASSERT_TRUE(std::abs(x - 325) < 40 || at(image, x, 100) == rgb(snapshot.view.background)) << x;
  }
}

TEST_P(RenderPicture, SmokeFollowsBeerAndLambert) {
  // Twice the smoke lets through the square of what once lets through.
  auto shareAt = [](float density) {
    Snapshot snapshot = scene(16, 9, 4, {LayerKind::smoke});
    snapshot.view.background = {0, 0, 0};
    snapshot.smoke.push_back({{1, 1, 1}, Field(16, 9, density)});
    return 1 - linearOf(at(drawn(snapshot, 160, 90), 80, 45).g);
  };
  EXPECT_NEAR(shareAt(1), shareAt(0.5f) * shareAt(0.5f), 0.01);
  EXPECT_NEAR(shareAt(0.5f), std::exp(-0.9), 0.01);
}

TEST_P(RenderPicture, NoPressureIsTheNeutralColor) {
  // Zero has the map's middle colour, with an asymmetric range too; the ends of the range have the ends'
  // colours.
  for (const std::array<double, 2> range : {std::array<double, 2>{-1, 1}, {-1, 5}}) {
    Snapshot snapshot = scene(16, 9, 4, {LayerKind::pressure});
    snapshot.pressureRange = range;
    const ColorMap& map = colorMap(ColorMapKind::pressure, true);
    for (const double u : {0.0, 1.0, -1.0}) {
      snapshot.pressure = Field(16, 9, static_cast<float>(u > 0 ? range[1] : u < 0 ? range[0] : 0));
      EXPECT_LE(difference(at(drawn(snapshot, 160, 90), 50, 40), rgb(map.at(u))), 2) << u;
    }
  }
}

TEST_P(RenderPicture, VorticityLiesOnNodes) {
  // A field that is odd about the domain's middle changes its sign there, to the pixel.
  Snapshot snapshot = scene(16, 9, 4, {LayerKind::vorticity});
  snapshot.vorticity = Field(17, 10);
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 17; ++i) snapshot.vorticity(i, j) = static_cast<float>((i - 8) / 8.0);
  const Image image = drawn(snapshot, 320, 180);
  const Rgb neutral = rgb(colorMap(ColorMapKind::vorticity, true).at(0));
  EXPECT_LE(difference(at(image, 159, 90), neutral), 3);
  EXPECT_LE(difference(at(image, 160, 90), neutral), 3);
  EXPECT_GT(at(image, 280, 90).r, at(image, 280, 90).g);  // violet
  EXPECT_GT(at(image, 40, 90).g, at(image, 40, 90).r);    // green
}

TEST_P(RenderPicture, NothingOfTheFluidIsPaintedOverASolid) {
  // Also if the list of layers has the solids first.
  Snapshot snapshot = scene(16, 9, 4, {LayerKind::solids, LayerKind::pressure});
  snapshot.pressure = Field(16, 9, 1);
  addCircle(snapshot, {2, 1.125}, 0.5, {0.2f, 0.8f, 0.4f});
  EXPECT_LE(difference(at(drawn(snapshot, 320, 180), 160, 90), rgb({0.2f, 0.8f, 0.4f})), 1);
}

TEST_P(RenderPicture, LetterboxKeepsTheAspect) {
  // A square domain in a wide picture stands in the middle, with another ground and a frame beside it.
  Snapshot snapshot = scene(16, 16, 4, {});
  const Image image = drawn(snapshot, 400, 200);
  const Rgb ground = rgb(snapshot.view.background);
  for (int x = 101; x < 299; ++x) ASSERT_EQ(at(image, x, 100), ground) << x;
  EXPECT_NE(at(image, 50, 100), ground);
  EXPECT_EQ(at(image, 50, 100), at(image, 350, 100));
  EXPECT_GT(at(image, 99, 100).g, ground.g + 20);  // the frame
  EXPECT_GT(at(image, 300, 100).g, ground.g + 20);
  EXPECT_LT(at(image, 97, 100).g, ground.g);
}

TEST_P(RenderPicture, CameraFramesAndFollows) {
  // A height of 1 m shows the followed solid in the middle, at a scale of the picture's height to a metre.
  Snapshot snapshot = scene(64, 36, 4, {LayerKind::solids});
  addCircle(snapshot, {2.7, 1.4}, 0.25, {1, 1, 1});
  snapshot.view.camera.follow = "circle";
  snapshot.view.camera.height = 1;
  const Image image = drawn(snapshot, 200, 200);
  EXPECT_GT(at(image, 100, 100).g, 200);
  EXPECT_GT(at(image, 100 + 48, 100).g, 200);
  EXPECT_LT(at(image, 100 + 53, 100).g, 60);
  EXPECT_LT(at(image, 100, 100 - 53).g, 60);
  snapshot.view.camera.center = Vec2{0.25, 0};  // relative to the solid
  EXPECT_LT(at(drawn(snapshot, 200, 200), 110, 100).g, 60);
}

TEST_P(RenderPicture, TextIsThereAndNowhereElse) {
  // The time stamp fills the upper left, the caption the lower middle; without their layers nothing is drawn.
  auto differing = [](const Image& image, const Rgb& ground, int x0, int y0, int x1, int y1) {
    int count = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) count += difference(at(image, x, y), ground) > 60;
    return count;
  };
  Snapshot snapshot = scene(64, 36, 4, {LayerKind::time, LayerKind::caption});
  snapshot.time = 1.25;
  const Rgb ground = rgb(snapshot.view.background);
  const Image stamp = drawn(snapshot, 1280, 720);
  EXPECT_GT(differing(stamp, ground, 0, 0, 200, 80), 150);
  EXPECT_EQ(differing(stamp, ground, 200, 80, 1280, 720), 0);
  snapshot.captions = {"vorticity on"};
  const Image caption = drawn(snapshot, 1280, 720);
  EXPECT_GT(differing(caption, ground, 400, 600, 880, 720), 400);
  snapshot.view.layers.clear();
  EXPECT_EQ(differing(drawn(snapshot, 1280, 720), ground, 0, 0, 1280, 720), 0);
}

TEST_P(RenderPicture, ArrowsStayOutOfSolids) {
  // In a uniform wind arrows are everywhere but inside the solid, and the same picture results twice.
  Snapshot snapshot = scene(64, 36, 4, {LayerKind::velocity});
  snapshot.velocityX = Field(64, 36, 1);
  snapshot.velocityY = Field(64, 36, 0);
  snapshot.speedRange = {0, 1};
  addCircle(snapshot, {2, 1.125}, 0.7, {1, 1, 1});  // not drawn: there is no layer of solids
  const Image image = drawn(snapshot, 1280, 720);
  int inside = 0, outside = 0;
  const Rgb ground = rgb(snapshot.view.background);
  for (int y = 0; y < 720; ++y)
    for (int x = 0; x < 1280; ++x) {
      const bool ink = difference(at(image, x, y), ground) > 60;
      const double r = std::hypot(x - 640.0, y - 360.0);
      inside += ink && r < 0.7 * 320 - 20;
      outside += ink && r > 0.7 * 320 + 20;
    }
  EXPECT_EQ(inside, 0);
  EXPECT_GT(outside, 10000);
}

TEST_P(RenderPicture, EveryLayerAtEverySize) {
  // Small, odd, tall and large pictures work with every layer at once, and a second draw gives the same
  // bytes.
  Snapshot snapshot =
      scene(64, 36, 4,
            {LayerKind::pressure, LayerKind::vorticity, LayerKind::speed, LayerKind::smoke, LayerKind::solids,
             LayerKind::velocity, LayerKind::probes, LayerKind::time, LayerKind::caption});
  for (LayerSpec& layer : snapshot.view.layers) layer.bar = true, layer.opacity = 0.5;
  snapshot.smoke.push_back({{1, 0.5f, 0.2f}, Field(64, 36, 0.3f)});
  snapshot.pressure = Field(64, 36, 0.4f);
  snapshot.vorticity = Field(65, 37, -0.4f);
  snapshot.velocityX = snapshot.velocityY = Field(64, 36, 0.5f);
  snapshot.periodicX = true;
  addCircle(snapshot, {1, 1}, 0.3, {0.5f, 0.5f, 0.5f});
  snapshot.probes = {{"p", {2, 1}, {}}, {"region", {}, {circle({3, 1}, 0.3)}}};
  snapshot.captions = {"one",
                       "another one that is long enough to be wrapped in any picture that is not very wide"};
  for (const auto& [w, h] : {std::pair{64, 36}, {1, 1}, {333, 77}, {90, 400}, {1281, 719}}) {
    Renderer renderer(w, h, GetParam());
    Image first, second;
    renderer.draw(snapshot, first);
    renderer.draw(snapshot, second);
    EXPECT_EQ(first.width, w);
    EXPECT_EQ(first.height, h);
    EXPECT_EQ(first.rgba, second.rgba) << w << "x" << h;
    if (w == 333) {
      EXPECT_EQ(first.rgba, drawn(snapshot, w, h).rgba) << "another renderer";
    }
  }
}

TEST_P(RenderPicture, TwoRenderersDoNotDisturbEachOther) {
  // Their contexts are taken in turn on one thread.
  Snapshot snapshot = scene(16, 9, 4, {LayerKind::solids});
  addCircle(snapshot, {2, 1.125}, 0.5, {0.9f, 0.2f, 0.2f});
  Renderer a(160, 90, GetParam()), b(320, 180, GetParam());
  Image one, other, again;
  a.draw(snapshot, one);
  b.draw(snapshot, other);
  a.draw(snapshot, again);
  EXPECT_EQ(one.rgba, again.rgba);
  EXPECT_EQ(other.width, 320);
}

TEST_P(RenderPicture, KnownCrashIsRefused) {
  // llvmpipe dies with vectors of 512 bits: that is an error with a message, not a crash.
  setenv("LP_NATIVE_VECTOR_WIDTH", "512", 1);
  EXPECT_THROW(Renderer(16, 16, GetParam()), GlError);
  unsetenv("LP_NATIVE_VECTOR_WIDTH");
}

}  // namespace
}  // namespace smokebox
