#include "render/encoded_lattice.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

namespace {
constexpr std::uint32_t kUnit = 256;  // so that a colour times it fits into 16 bits
}  // namespace

SrgbEncoder::SrgbEncoder() {
  for (int k = 0; k <= kSteps; ++k) {
    const double root = double(k) / kSteps, light = root * root;
    const double encoded = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
    bytes_[k] = static_cast<std::uint32_t>(std::lround(255 * std::clamp(encoded, 0.0, 1.0)));
  }
}

std::uint32_t SrgbEncoder::packed(const LinearColor& color) const {
  std::uint32_t out = 0xff000000u;
  for (int c = 0; c < 3; ++c) {
    const float root = std::sqrt(std::clamp(color[c], 0.0f, 1.0f));
    out |= atRoot(static_cast<int>(root * kSteps + 0.5f)) << (8 * c);
  }
  return out;
}

void appendTiles(const std::vector<PictureTile>& tiles, const Lattice& lattice, const GlTexture& texture,
                 const PictureFrame& frame, std::vector<float>& records) {
  auto u = [&](double x) {
    return float(((x - lattice.origin.x) / lattice.spacing + 0.5) / texture.width());
  };
  auto v = [&](double y) {
    return float(((y - lattice.origin.y) / lattice.spacing + 0.5) / texture.height());
  };
  for (const PictureTile& tile : tiles) {
    if (tile.x0 >= tile.x1 || tile.y0 >= tile.y1) continue;
    const Vec2 upperLeft = frame.toWorld({tile.x0, tile.y0}), lowerRight = frame.toWorld({tile.x1, tile.y1});
    records.insert(records.end(), {float(tile.x0), float(tile.y0), float(tile.x1), float(tile.y1),
                                   u(upperLeft.x), v(upperLeft.y), u(lowerRight.x), v(lowerRight.y)});
  }
}

void EncodedLattice::place(Places& places, int first, int past, double atFirst, double step, int samples) {
  places.sample.resize(past - first);
  places.share.resize(past - first);
  for (int k = 0; k < past - first; ++k) {
    const double at = std::clamp(atFirst + k * step, 0.0, double(samples - 1));
    const int sample = std::min(static_cast<int>(at), std::max(samples - 2, 0));
    places.sample[k] = sample;
    places.share[k] = static_cast<std::uint32_t>(std::lround((at - sample) * kUnit));
  }
}

/// A row of samples to a row of pixels, two colours at a time in the halves of an integer: 8 bits and 8 more
/// behind the point.
void EncodedLattice::spread(const std::uint32_t* samples, int next, int width,
                            std::uint32_t* __restrict redBlue, std::uint32_t* __restrict green) const {
  const int* const sample = columns_.sample.data();
  const std::uint32_t* const share = columns_.share.data();
  for (int x = 0; x < width; ++x) {
    const std::uint32_t a = samples[sample[x]], b = samples[sample[x] + next], w = share[x];
    redBlue[x] = (a & 0xff00ff) * (kUnit - w) + (b & 0xff00ff) * w;
    green[x] = (a >> 8 & 0xff) * (kUnit - w) + (b >> 8 & 0xff) * w;
  }
}

void EncodedLattice::paint(const PictureTile& tile, const std::vector<std::uint32_t>& colors,
                           const Lattice& lattice, const PictureFrame& frame) {
  // The pixels whose centres lie inside.
  auto firstPixel = [](double edge, int size) {
    return std::clamp(static_cast<int>(std::ceil(edge - 0.5)), 0, size);
  };
  const int x0 = firstPixel(tile.x0, frame.width), x1 = firstPixel(tile.x1, frame.width);
  const int y0 = firstPixel(tile.y0, frame.height), y1 = firstPixel(tile.y1, frame.height);
  if (x0 >= x1 || y0 >= y1) return;
  const Vec2 at = frame.toWorld({x0 + 0.5, y0 + 0.5});
  const double step = 1 / (frame.scale * lattice.spacing);
  place(columns_, x0, x1, (at.x - lattice.origin.x) / lattice.spacing, step, lattice.nx);
  place(rows_, y0, y1, (at.y - lattice.origin.y) / lattice.spacing, -step, lattice.ny);
  const int width = x1 - x0;
  const int next = lattice.nx > 1;  // from a sample to its neighbour
  int held[2] = {-1, -1};           // the rows that spread_ holds, even and odd
  for (std::vector<std::uint32_t>& row : spread_) row.resize(std::size_t(2) * width);
  auto spreadRow = [&](int j) {
    std::uint32_t* const out = spread_[j & 1].data();
    if (held[j & 1] != j) spread(colors.data() + std::size_t(j) * lattice.nx, next, width, out, out + width);
    held[j & 1] = j;
    return out;
  };
  for (int y = y0; y < y1; ++y) {
    const int j = rows_.sample[y - y0];
    const std::uint32_t w = rows_.share[y - y0], v = kUnit - w, half = kUnit * kUnit / 2;
    const std::uint32_t* const a = spreadRow(j);
    const std::uint32_t* const b = spreadRow(std::min(j + 1, lattice.ny - 1));
    std::uint32_t* __restrict const out = pixels_.data() + std::size_t(y) * frame.width + x0;
    for (int x = 0; x < width; ++x) {
      const std::uint32_t red = (a[x] & 0xffff) * v + (b[x] & 0xffff) * w + half;
      const std::uint32_t blue = (a[x] >> 16) * v + (b[x] >> 16) * w + half;
      const std::uint32_t green = a[width + x] * v + b[width + x] * w + half;
      out[x] = red >> 16 | (green >> 8 & 0xff00) | (blue & 0xff0000) | 0xff000000u;
    }
  }
}

void EncodedLattice::draw(std::uint32_t ground, const std::vector<std::uint32_t>& colors,
                          const Lattice& lattice, const std::vector<PictureTile>& tiles,
                          const PictureFrame& frame) {
  pixels_.assign(std::size_t(frame.width) * frame.height, ground);
  for (const PictureTile& tile : tiles) paint(tile, colors, lattice, frame);
  target_.write(pixels_.data());
}

}  // namespace smokebox
