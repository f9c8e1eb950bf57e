#include <algorithm>
#include <bit>
#include <cmath>

#include "render/layers.h"

namespace smokebox {

namespace {
// Smoke of value 1 hides 1 - exp(-thickness) of what is behind: 83% and 95%. A light ground needs more for
// the same strength of colour, for it shines through far brighter.
constexpr double kThicknessOnDark = 1.8, kThicknessOnLight = 3.0;
constexpr float kInvisible = 1e-5f;  // a density that changes no pixel
constexpr int kRunSamples = 64;      // samples that are coloured together
constexpr float kFilled = 1e-3f;     // weight of a closed cell that was given a value
constexpr int kTilePixels = 64;      // edge of the tiles that llvmpipe draws in
constexpr int kRunCells = 16;        // cells that are looked at together
constexpr int kReach = 3;           // cells beyond its own that a value can be seen, filled solids counted in
constexpr double kReachPixels = 3;  // the same where cells are finer than pixels

float thicknessOn(const PictureFrame& frame) {
  return float((frame.darkGround ? kThicknessOnDark : kThicknessOnLight) / std::log(2.0));
}

/// 2^-x for x >= 0 within 2e-5, in operations that the compiler turns into vectors.
inline float halvings(float x) {
  x = std::min(x, 120.0f);
  const int whole = static_cast<int>(x);
  const float y = (x - static_cast<float>(whole)) * 0.693147181f;
  // The series of exp(-y).
  const float part =
      1 +
      y * (-1 + y * (1 / 2.0f + y * (-1 / 6.0f + y * (1 / 24.0f + y * (-1 / 120.0f + y * (1 / 720.0f))))));
  return part * std::bit_cast<float>((127 - whole) << 23);
}

/// The largest, at least 0.
inline float largest(const float* values, int count) {
  float most = 0;
#pragma omp simd reduction(max : most)
  for (int k = 0; k < count; ++k) most = values[k] > most ? values[k] : most;
  return most;
}

/// What a run of smoke shows: its colours over the ground.
struct Shade {
  LinearColor ground, color;  // color: of smoke that has one only
  float thickness, opacity;
};

/// What smoke.frag does, and the ground under it, for each sample.
template <int kChannels>
void colorRun(const float* row, int count, const Shade& shade, const SrgbEncoder& encoder,
              std::uint32_t* out) {
  int roots[3][kRunSamples];
  for (int i = 0; i < count; ++i) {
    const float density = std::max(row[i * kChannels + kChannels - 1], 0.0f);
    const float alpha = shade.opacity * (1 - halvings(shade.thickness * density));
    const float weight = alpha / std::max(density, 1e-9f);
    for (int c = 0; c < 3; ++c) {
      const float smoke = kChannels == 1 ? alpha * shade.color[c] : weight * row[i * kChannels + c];
      const float light = std::clamp(shade.ground[c] * (1 - alpha) + smoke, 0.0f, 1.0f);
      roots[c][i] = static_cast<int>(SrgbEncoder::kSteps * std::sqrt(light) + 0.5f);
    }
  }
  for (int i = 0; i < count; ++i)
    out[i] = encoder.atRoot(roots[0][i]) | encoder.atRoot(roots[1][i]) << 8 |
             encoder.atRoot(roots[2][i]) << 16 | 0xff000000u;
}
}  // namespace

SmokeLayer::SmokeLayer(const Gl& gl, GlTarget& target)
    : oneColor_(gl, "smoke.vert", "smoke.frag", "#define ONE_COLOR\n"),
      manyColors_(gl, "smoke.vert", "smoke.frag"),
      density_(gl, GL_R32F, GL_RED, GL_FLOAT, GL_LINEAR),
      colors_(gl, GL_RGBA32F, GL_RGBA, GL_FLOAT, GL_LINEAR),
      tiles_(gl, {4, 4}),
      encoded_(target) {}

void SmokeLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame,
                      bool onGround) {
  const Grid& grid = snapshot.grid;
  const Vec2 first{grid.h / 2, grid.h / 2};
  const LatticeWindow window = visibleWindow(frame, grid, first, grid.nx, grid.ny);
  gather(snapshot, window);
  chooseTiles(snapshot.grid, window, frame);
  if (smoky_.empty() && !onGround) return;
  fillClosedCells();
  lattice_.origin = {first.x + window.i0 * grid.h, first.y + window.j0 * grid.h};
  lattice_.spacing = grid.h;
  smoothFor(lattice_, frame.scale, scratch_);
  if (onGround)
    drawOnGround(snapshot, layer, frame);
  else
    drawBlended(snapshot, layer, frame);
}

/// Densities (one colour), or the sums of colour times density and of density (many), and the open shares.
void SmokeLayer::gather(const Snapshot& snapshot, const LatticeWindow& window) {
  const Grid& grid = snapshot.grid;
  const int periodX = snapshot.periodicX ? grid.nx : 0, periodY = snapshot.periodicY ? grid.ny : 0;
  const bool one = snapshot.smoke.size() == 1;
  lattice_.resize(window.nx(), window.ny(), one ? 1 : 4);
  openShare_.resize(std::size_t(window.nx()) * window.ny());
  std::fill(lattice_.values.begin(), lattice_.values.end(), 0.0f);
  // Columns outside of the domain repeat some inside; those inside are a plain run.
  const int runBegin = std::clamp(0, window.i0, window.i1), runEnd = std::clamp(grid.nx, runBegin, window.i1);
  auto eachColumn = [&](auto&& body) {
    for (int i = window.i0; i < runBegin; ++i) body(i, wrapIndex(i, grid.nx, periodX));
    for (int i = runBegin; i < runEnd; ++i) body(i, i);
    for (int i = runEnd; i < window.i1; ++i) body(i, wrapIndex(i, grid.nx, periodX));
  };
  for (int j = window.j0; j < window.j1; ++j) {
    const int source = wrapIndex(j, grid.ny, periodY);
    float* out = lattice_.row(j - window.j0);
    float* open = openShare_.data() + std::size_t(j - window.j0) * window.nx();
    const float* openRow = snapshot.open.empty() ? nullptr : snapshot.open.row(source);
    eachColumn([&](int i, int from) { open[i - window.i0] = openRow ? openRow[from] : 1.0f; });
    for (const SmokePicture& smoke : snapshot.smoke) {
      const float* row = smoke.value.row(source);
      if (one) {
        eachColumn([&](int i, int from) { out[i - window.i0] = std::max(row[from], 0.0f); });
        continue;
      }
      const LinearColor color = linear(smoke.color);
      auto add = [&](int begin, int end, int shift) {
        for (int i = begin; i < end; ++i) {
          const float density = std::max(row[i + shift], 0.0f);
          float* to = out + 4 * (i - window.i0);
          for (int c = 0; c < 4; ++c) to[c] += color[c] * density;  // color[3] is 1
        }
      };
      for (int i = window.i0; i < runBegin; ++i) add(i, i + 1, wrapIndex(i, grid.nx, periodX) - i);
      for (int begin = runBegin; begin < runEnd; begin += kRunCells) {
        // A place has few of many colours.
        const int end = std::min(begin + kRunCells, runEnd);
        if (largest(row + begin, end - begin) > 0) add(begin, end, 0);
      }
      for (int i = runEnd; i < window.i1; ++i) add(i, i + 1, wrapIndex(i, grid.nx, periodX) - i);
    }
  }
}

/// Cells inside solids hold nothing, and would draw a dark rim along them. They take the average of their
/// neighbours, weighted by how open those are; then once more for the second row of cells, as far as the
/// spline reaches.
void SmokeLayer::fillClosedCells() {
  const int nx = lattice_.nx, ny = lattice_.ny, channels = lattice_.channels;
  unreached_.clear();
  auto fill = [&](int i, int j) {
    float weight = 0, sum[4] = {};
    for (int b = std::max(j - 1, 0); b <= std::min(j + 1, ny - 1); ++b)
      for (int a = std::max(i - 1, 0); a <= std::min(i + 1, nx - 1); ++a) {
        const float w = openShare_[std::size_t(b) * nx + a];
        if (w <= 0) continue;
        weight += w;
        for (int c = 0; c < channels; ++c) sum[c] += w * lattice_.row(b)[a * channels + c];
      }
    if (weight <= 0) return false;
    float* own = lattice_.row(j) + i * channels;
    for (int c = 0; c < channels; ++c) own[c] = sum[c] / weight;
    return true;
  };
  std::vector<int> reached;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      // Only closed samples are changed here, and those have no weight: the order does not matter.
      if (openShare_[std::size_t(j) * nx + i] > 0) continue;
      (fill(i, j) ? reached : unreached_).push_back(j * nx + i);
    }
  for (const int k : reached) openShare_[k] = kFilled;
  for (const int k : unreached_) fill(k % nx, k / nx);
}

/// The parts of the picture where any smoke can be seen: nothing is drawn elsewhere. They are made of the
/// rasteriser's own tiles, which it fills far faster whole than in part.
void SmokeLayer::chooseTiles(const Grid& grid, const LatticeWindow& window, const PictureFrame& frame) {
  const int channels = lattice_.channels;
  const int tilesX = (frame.width + kTilePixels - 1) / kTilePixels;
  const int tilesY = (frame.height + kTilePixels - 1) / kTilePixels;
  std::vector<char> smoky(std::size_t(tilesX) * tilesY, 0);
  auto tileOf = [](double pixel, int count) {
    return std::clamp(static_cast<int>(std::floor(pixel / kTilePixels)), 0, count - 1);
  };
  for (int j = 0; j < window.ny(); ++j)
    for (int begin = 0; begin < window.nx(); begin += kRunCells) {
      const int end = std::min(begin + kRunCells, window.nx());
      // Of densities, and colours weighed by them.
      if (largest(lattice_.row(j) + begin * channels, (end - begin) * channels) <= kInvisible) continue;
      const Vec2 low =
          frame.toPixels({(window.i0 + begin - kReach) * grid.h, (window.j0 + j - kReach) * grid.h});
      const Vec2 high =
          frame.toPixels({(window.i0 + end + kReach) * grid.h, (window.j0 + j + 1 + kReach) * grid.h});
      const int x1 = tileOf(high.x + kReachPixels, tilesX), y1 = tileOf(low.y + kReachPixels, tilesY);
      for (int y = tileOf(high.y - kReachPixels, tilesY); y <= y1; ++y)
        for (int x = tileOf(low.x - kReachPixels, tilesX); x <= x1; ++x)
          smoky[std::size_t(y) * tilesX + x] = 1;
    }
  smoky_.clear();
  for (int y = 0; y < tilesY;) {
    // Rows of tiles that are alike are drawn as one.
    const char* row = smoky.data() + std::size_t(y) * tilesX;
    int pastY = y + 1;
    while (pastY < tilesY && std::equal(row, row + tilesX, smoky.data() + std::size_t(pastY) * tilesX))
      ++pastY;
    for (int x = 0; x < tilesX;) {
      const int begin = x;
      while (x < tilesX && row[x]) ++x;
      if (x > begin)
        smoky_.push_back({std::max(frame.left, double(begin * kTilePixels)),
                          std::max(frame.top, double(y * kTilePixels)),
                          std::min(frame.right, double(x * kTilePixels)),
                          std::min(frame.bottom, double(pastY * kTilePixels))});
      else
        ++x;
    }
    y = pastY;
  }
}

void SmokeLayer::drawBlended(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  const bool one = lattice_.channels == 1;
  const GlProgram& program = one ? oneColor_ : manyColors_;
  GlTexture& texture = one ? density_ : colors_;
  texture.bind(0);
  texture.upload(lattice_.nx, lattice_.ny, lattice_.values.data());
  records_.clear();
  appendTiles(smoky_, lattice_, texture, frame, records_);
  program.use();
  program.set("pictureSize", float(frame.width), float(frame.height));
  program.set("lattice", 0);
  program.set("thickness", thicknessOn(frame));
  program.set("opacity", float(layer.opacity));
  program.set("color", linear(snapshot.smoke.front().color));
  tiles_.draw(records_);
}

void SmokeLayer::drawOnGround(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  const Shade shade{linear(snapshot.view.background), linear(snapshot.smoke.front().color),
                    thicknessOn(frame), float(layer.opacity)};
  const std::uint32_t nothing = encoder_.packed(shade.ground);
  const int nx = lattice_.nx, channels = lattice_.channels;
  finished_.resize(std::size_t(nx) * lattice_.ny);
  for (int j = 0; j < lattice_.ny; ++j)
    for (int begin = 0; begin < nx; begin += kRunSamples) {
      const int count = std::min(kRunSamples, nx - begin);
      const float* const row = lattice_.row(j) + std::size_t(begin) * channels;
      std::uint32_t* const out = finished_.data() + std::size_t(j) * nx + begin;
      if (largest(row, count * channels) <= kInvisible)
        std::fill_n(out, count, nothing);
      else if (channels == 1)
        colorRun<1>(row, count, shade, encoder_, out);
      else
        colorRun<4>(row, count, shade, encoder_, out);
    }
  encoded_.draw(nothing, finished_, lattice_, smoky_, frame);
}

}  // namespace smokebox
