// The ways to OpenGL beside each other: in turn, at once, and against each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <thread>
#include <vector>

#include "base/errors.h"
#include "base/maths.h"
#include "render/renderer.h"

namespace smokebox {
namespace {

constexpr int kWidth = 480, kHeight = 270;

/// Everything that a picture can have: two colours of smoke, fields with bars, text, arrows, solids, probes.
Snapshot everything() {
  Snapshot snapshot;
  snapshot.grid = {64, 36, 4.0 / 64};
  snapshot.open = Field(64, 36, 1);
  for (const LayerKind kind :
       {LayerKind::smoke, LayerKind::pressure, LayerKind::vorticity, LayerKind::speed, LayerKind::solids,
        LayerKind::velocity, LayerKind::probes, LayerKind::time, LayerKind::caption}) {
    LayerSpec layer;
    layer.kind = kind;
    layer.opacity = kind == LayerKind::smoke || kind == LayerKind::solids ? 1 : 0.6;
    snapshot.view.layers.push_back(layer);
  }
  snapshot.smoke.push_back({{1, 0.5f, 0.2f}, Field(64, 36)});
  snapshot.smoke.push_back({{0.3f, 0.7f, 1}, Field(64, 36)});
  snapshot.pressure = snapshot.velocityX = snapshot.velocityY = Field(64, 36);
  snapshot.vorticity = Field(65, 37);
  for (int j = 0; j < 37; ++j)
    for (int i = 0; i < 65; ++i) {
      const double x = 0.2 * i, y = 0.3 * j;
      snapshot.vorticity(i, j) = static_cast<float>(std::sin(x) * std::cos(y));
      if (i == 64 || j == 36) continue;
      snapshot.smoke[0].value(i, j) = static_cast<float>(0.4 + 0.4 * std::cos(x));
      snapshot.smoke[1].value(i, j) = static_cast<float>(0.3 + 0.3 * std::sin(y));
      snapshot.pressure(i, j) = static_cast<float>(std::cos(x + y));
      snapshot.velocityX(i, j) = static_cast<float>(std::sin(y));
      snapshot.velocityY(i, j) = static_cast<float>(std::cos(x));
    }
  SolidPicture solid;
  solid.name = "disk";
  Outline outline;
  for (int k = 0; k < 64; ++k)
    outline.push_back({1.3 + 0.3 * std::cos(2 * kPi * k / 64), 1.1 + 0.3 * std::sin(2 * kPi * k / 64)});
  solid.outlines = {outline};
  snapshot.solids.push_back(solid);
  snapshot.probes = {{"p", {2, 1}, {}}};
  snapshot.captions = {"Pressure, speed and vorticity at once"};
  snapshot.time = 1.25;
  return snapshot;
}

std::vector<std::uint8_t> bytes(Renderer& renderer, const Snapshot& snapshot) {
  Image image;
  renderer.draw(snapshot, image);
  return image.rgba;
}

std::vector<std::uint8_t> bytes(GlBackend backend, const Snapshot& snapshot) {
  Renderer renderer(kWidth, kHeight, backend);
  return bytes(renderer, snapshot);
}

class RenderBackends : public testing::Test {
 protected:
  RenderBackends() { preferDrawingAlone(); }
};

TEST_F(RenderBackends, DrawTheSameBytes) {
  // One Mesa draws behind each: a picture with everything in it is the same, whichever way it was drawn.
  const std::vector<GlBackend> built = builtGlBackends();
  if (built.size() < 2) GTEST_SKIP() << "one way to OpenGL is built";
  const Snapshot snapshot = everything();
  const std::vector<std::uint8_t> first = bytes(built[0], snapshot), second = bytes(built[1], snapshot);
  EXPECT_GT(*std::max_element(first.begin(), first.end()), 200);
  EXPECT_TRUE(first == second);
}

TEST_F(RenderBackends, WorkInTwoThreadsAtOnce) {
  // Each thread has a context of its own, of any backend; what they draw is what one alone draws, while
  // others come and go.
  const Snapshot snapshot = everything();
  for (const GlBackend first : builtGlBackends())
    for (const GlBackend second : builtGlBackends()) {
      const std::vector<std::uint8_t> alone = bytes(first, snapshot);
      int same[2] = {0, 0};
      auto drawOften = [&](GlBackend backend, int& count) {
        for (int k = 0; k < 3; ++k) {
          Renderer renderer(kWidth, kHeight, backend);
          for (int frame = 0; frame < 3; ++frame) count += bytes(renderer, snapshot) == alone;
        }
      };
      std::thread other([&] { drawOften(second, same[1]); });
      drawOften(first, same[0]);
      other.join();
      EXPECT_EQ(same[0], 9) << nameOf(first) << " beside " << nameOf(second);
      EXPECT_EQ(same[1], 9) << nameOf(second) << " beside " << nameOf(first);
    }
}

TEST_F(RenderBackends, TakeTurnsOnOneThread) {
  // Contexts of all backends live on one thread; that one goes does not disturb those that stay.
  const Snapshot snapshot = everything();
  std::vector<std::unique_ptr<Renderer>> renderers;
  for (int k = 0; k < 2; ++k)
    for (const GlBackend backend : builtGlBackends())
      renderers.push_back(std::make_unique<Renderer>(kWidth, kHeight, backend));
  const std::vector<std::uint8_t> expected = bytes(*renderers.front(), snapshot);
  while (!renderers.empty()) {
    for (int k = 0; k < 2; ++k)
      for (const auto& renderer : renderers) EXPECT_TRUE(bytes(*renderer, snapshot) == expected);
    renderers.erase(renderers.begin());
  }
}

TEST_F(RenderBackends, HaveNames) {
  // A name leads to its backend, none to the default, and one that is not built is wrong usage that says what
  // there is.
  for (const GlBackend backend : builtGlBackends()) EXPECT_EQ(glBackendNamed(nameOf(backend)), backend);
  EXPECT_EQ(glBackendNamed(""), builtGlBackends().front());
  try {
    glBackendNamed("glide");
    FAIL();
  } catch (const UsageError& error) {
    for (const GlBackend backend : builtGlBackends())
      EXPECT_NE(std::string(error.what()).find(nameOf(backend)), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace smokebox
