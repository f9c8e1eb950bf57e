#include <algorithm>
#include <cmath>

#include "render/layers.h"

namespace smokebox {

namespace {
// Smoke of value 1 hides 1 - exp(-thickness) of what is behind: 83% and 95%. A light ground needs more for
// the same strength of colour, for it shines through far brighter.
constexpr double kThicknessOnDark = 1.8, kThicknessOnLight = 3.0;
constexpr float kInvisible = 1e-5f;  // a density that changes no pixel
constexpr float kFilled = 1e-3f;     // weight of a closed cell that was given a value
constexpr int kTilePixels = 64;      // edge of the tiles that llvmpipe draws in
constexpr int kRunCells = 16;        // cells that are looked at together
constexpr int kReach = 3;           // cells beyond its own that a value can be seen, filled solids counted in
constexpr double kReachPixels = 3;  // the same where cells are finer than pixels
}  // namespace

SmokeLayer::SmokeLayer(const Gl& gl)
    : gl_(gl),
      oneColor_(gl, "smoke.vert", "smoke.frag", "#define ONE_COLOR\n"),
      oneColorOnGround_(gl, "smoke.vert", "smoke.frag", "#define ONE_COLOR\n#define ON_GROUND\n"),
      manyColors_(gl, "smoke.vert", "smoke.frag"),
      manyColorsOnGround_(gl, "smoke.vert", "smoke.frag", "#define ON_GROUND\n"),
      density_(gl, GL_R32F, GL_RED, GL_FLOAT, GL_LINEAR),
      colors_(gl, GL_RGBA32F, GL_RGBA, GL_FLOAT, GL_LINEAR),
      tiles_(gl, {4, 4}) {}

void SmokeLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame,
                      bool onGround) {
  if (snapshot.smoke.empty()) return;
  const Grid& grid = snapshot.grid;
  const Vec2 first{grid.h / 2, grid.h / 2};
  const LatticeWindow window = visibleWindow(frame, grid, first, grid.nx, grid.ny);
  gather(snapshot, window);
  chooseTiles(snapshot.grid, window, frame);
  if (smoky_.empty()) return;
  fillClosedCells();
  lattice_.origin = {first.x + window.i0 * grid.h, first.y + window.j0 * grid.h};
  lattice_.spacing = grid.h;
  smoothFor(lattice_, frame.scale, scratch_);
  if (onGround) gl_.Disable(GL_BLEND);
  if (lattice_.channels == 1)
    drawTiles(onGround ? oneColorOnGround_ : oneColor_, density_, snapshot, layer, frame);
  else
    drawTiles(onGround ? manyColorsOnGround_ : manyColors_, colors_, snapshot, layer, frame);
  gl_.Enable(GL_BLEND);
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
      eachColumn([&](int i, int from) {
        const float density = std::max(row[from], 0.0f);
        float* to = out + 4 * (i - window.i0);
        to[0] += color[0] * density;
        to[1] += color[1] * density;
        to[2] += color[2] * density;
        to[3] += density;
      });
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
  const int channels = lattice_.channels, last = channels - 1;
  const int tilesX = (frame.width + kTilePixels - 1) / kTilePixels;
  const int tilesY = (frame.height + kTilePixels - 1) / kTilePixels;
  std::vector<char> smoky(std::size_t(tilesX) * tilesY, 0);
  auto tileOf = [](double pixel, int count) {
    return std::clamp(static_cast<int>(std::floor(pixel / kTilePixels)), 0, count - 1);
  };
  for (int j = 0; j < window.ny(); ++j)
    for (int begin = 0; begin < window.nx(); begin += kRunCells) {
      const int end = std::min(begin + kRunCells, window.nx());
      const float* row = lattice_.row(j);
      float most = 0;
      for (int i = begin; i < end; ++i) most = std::max(most, row[i * channels + last]);
      if (most <= kInvisible) continue;
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

void SmokeLayer::drawTiles(const GlProgram& program, GlTexture& texture, const Snapshot& snapshot,
                           const LayerSpec& layer, const PictureFrame& frame) {
  texture.bind(0);
  texture.upload(lattice_.nx, lattice_.ny, lattice_.values.data());
  auto u = [&](double x) {
    return float(((x - lattice_.origin.x) / lattice_.spacing + 0.5) / texture.width());
  };
  auto v = [&](double y) {
    return float(((y - lattice_.origin.y) / lattice_.spacing + 0.5) / texture.height());
  };
  records_.clear();
  for (const Tile& tile : smoky_) {
    if (tile.x0 >= tile.x1 || tile.y0 >= tile.y1) continue;
    const Vec2 upperLeft = frame.toWorld({tile.x0, tile.y0}), lowerRight = frame.toWorld({tile.x1, tile.y1});
    records_.insert(records_.end(), {float(tile.x0), float(tile.y0), float(tile.x1), float(tile.y1),
                                     u(upperLeft.x), v(upperLeft.y), u(lowerRight.x), v(lowerRight.y)});
  }
  program.use();
  program.set("pictureSize", float(frame.width), float(frame.height));
  program.set("lattice", 0);
  program.set("thickness", float((frame.darkGround ? kThicknessOnDark : kThicknessOnLight) / std::log(2.0)));
  program.set("opacity", float(layer.opacity));
  program.set("ground", linear(snapshot.view.background));
  program.set("color", linear(snapshot.smoke.front().color));
  tiles_.draw(records_);
}

}  // namespace smokebox
