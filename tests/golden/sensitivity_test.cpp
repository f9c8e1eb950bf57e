// The measure behind the golden tests is sharp enough: small faults in these very pictures are seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "golden/set/golden_run.h"
#include "image/png.h"
#include "world/ranges.h"

namespace smokebox::golden {

namespace {

std::string nameOfRow(const testing::TestParamInfo<Row>& instance) { return testName(instance.param.name); }

/// "" if the fault is seen, else how close it came.
std::string unseen(const Image& right, const Image& wrong, const DifferenceTolerance& tolerance) {
  const ImageDifference difference = measureDifference(right, wrong, tolerance);
  return difference.within(tolerance) ? difference.inWords(tolerance) : "";
}

struct Rectangle {
  int left = 0, top = 0, right = 0, bottom = 0;  // the last two are beyond it
  bool empty() const { return right <= left; }
};

// --- a patch

/// Makes a channel one level brighter in a patch; darker, where more of the patch is at the end of its scale.
Image withPatch(Image image, const Rectangle& patch, int channel) {
  std::vector<std::uint8_t*> values;
  for (int y = patch.top; y < patch.bottom; ++y)
    for (int x = patch.left; x < patch.right; ++x)
      values.push_back(&image.rgba[4 * (std::size_t(y) * image.width + x) + channel]);
  const auto full = std::count_if(values.begin(), values.end(), [](auto* v) { return *v == 255; });
  const auto none = std::count_if(values.begin(), values.end(), [](auto* v) { return *v == 0; });
  for (std::uint8_t* value : values)
    *value = static_cast<std::uint8_t>(full <= none ? std::min(*value + 1, 255) : std::max(*value - 1, 0));
  return image;
}

class Patch : public testing::TestWithParam<Row> {};

TEST_P(Patch, OfOneLevelIsSeen) {
  // Truth: one channel off by one level in a patch of 20x20 pixels, wherever it lies, breaks the tolerance.
  constexpr int kSide = 20;
  for (const double time : GetParam().times) {
    const Image golden = readPng(GetParam().image(time));
    const int side = std::min({kSide, golden.width, golden.height});
    for (int place = 0; place < 9; ++place) {
      const int left = place % 3 * (golden.width - side) / 2, top = place / 3 * (golden.height - side) / 2;
      const Image wrong = withPatch(golden, {left, top, left + side, top + side}, place % 3);
      EXPECT_EQ(unseen(golden, wrong, GetParam().tolerance), "")
          << GetParam().pictureName(time) << " at (" << left << ", " << top << ")";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sensitivity, Patch, testing::ValuesIn(rows()), nameOfRow);

// --- text

/// Where two pictures differ.
Rectangle differing(const Image& a, const Image& b) {
  Rectangle box{a.width, a.height, 0, 0};
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const std::size_t k = 4 * (std::size_t(y) * a.width + x);
      if (std::equal(&a.rgba[k], &a.rgba[k] + 3, &b.rgba[k])) continue;
      box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x + 1),
             std::max(box.bottom, y + 1)};
    }
  return box;
}

Image moved(const Image& image, const Rectangle& box, int dx, int dy) {
  Image out = image;
  for (int y = std::max(box.top, dy); y < std::min(box.bottom, image.height + dy); ++y)
    for (int x = std::max(box.left, dx); x < std::min(box.right, image.width + dx); ++x)
      std::copy_n(&image.rgba[4 * (std::size_t(y - dy) * image.width + x - dx)], 4,
                  &out.rgba[4 * (std::size_t(y) * image.width + x)]);
  return out;
}

class Text : public testing::TestWithParam<Row> {};

TEST_P(Text, MovedByAPixelIsSeen) {
  // Truth: the caption or the time stamp a pixel further in any direction breaks the tolerance. Where it
  // stands is found by drawing the same without it.
  const Row& row = GetParam();
  const std::vector<Image> with = draw(row, {});
  int checked = 0;
  for (const LayerSpec& layer : row.document().spec().view.layers) {
    if (layer.kind != LayerKind::caption && layer.kind != LayerKind::time) continue;
    const std::string path = std::string("view.layers.") + layerName(layer.kind);
    const std::vector<Image> without = draw(row, {}, {path + ".opacity=0"});
    for (std::size_t k = 0; k < with.size(); ++k) {
      const Rectangle box = differing(with[k], without[k]);
      if (box.empty()) continue;  // no caption is up at this time
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
        EXPECT_EQ(unseen(with[k], moved(with[k], box, dx, dy), row.tolerance), "")
            << row.pictureName(row.times[k]) << ", " << path << " moved by (" << dx << ", " << dy << ")";
      ++checked;
    }
  }
  EXPECT_GT(checked, 0);
}

std::vector<Row> rowsWith(bool (*wanted)(const SceneSpec& spec)) {
  std::vector<Row> found;
  for (const Row& row : rows()) {
    try {
      if (wanted(row.document().spec())) found.push_back(row);
    } catch (const std::exception&) {  // another test tells that its scene is wrong
    }
  }
  return found;
}

bool hasText(const SceneSpec& spec) {
  const auto isTime = [](const LayerSpec& layer) { return layer.kind == LayerKind::time; };
  return !spec.view.captions.empty() || std::any_of(spec.view.layers.begin(), spec.view.layers.end(), isTime);
}

INSTANTIATE_TEST_SUITE_P(Sensitivity, Text, testing::ValuesIn(rowsWith(hasText)), nameOfRow);

// --- ranges

/// Nothing for a layer that is no field. A new kind of layer does not compile before it is named here.
std::optional<std::array<double, 2>> rangeOf(const FilmRanges& ranges, LayerKind kind) {
  switch (kind) {
    case LayerKind::pressure:
      return ranges.pressure;
    case LayerKind::vorticity:
      return ranges.vorticity;
    case LayerKind::speed:
      return ranges.speed;
    case LayerKind::temperature:
      return ranges.temperature;
    case LayerKind::smoke:
    case LayerKind::solids:
    case LayerKind::velocity:
    case LayerKind::caption:
    case LayerKind::time:
    case LayerKind::probes:
    case LayerKind::bodies:
    case LayerKind::particles:
    case LayerKind::springs:
    case LayerKind::joints:
    case LayerKind::cloth:
    case LayerKind::trails:
    case LayerKind::collisions:
      break;
  }
  return {};
}

bool showsField(const LayerSpec& layer) { return layer.shown && rangeOf({}, layer.kind); }

bool hasField(const SceneSpec& spec) {
  return std::any_of(spec.view.layers.begin(), spec.view.layers.end(), showsField);
}

class Range : public testing::TestWithParam<Row> {};

TEST_P(Range, OffByTwoPercentIsSeen) {
  // Truth: a field drawn in a range whose ends are 2% too far or too near breaks the tolerance, with the
  // colour bar and without it.
  const Row& row = GetParam();
  const SceneDocument document = row.document();
  const FilmRanges ranges = findRanges(document, 1);
  for (const LayerSpec& layer : document.spec().view.layers) {
    if (!showsField(layer)) continue;
    const std::string path = std::string("view.layers.") + layerName(layer.kind);
    const std::array<double, 2> range = *rangeOf(ranges, layer.kind);
    const auto drawn = [&](double factor, bool bar) {
      char ends[80];
      std::snprintf(ends, sizeof ends, ".range=[%.17g, %.17g]", factor * range[0], factor * range[1]);
      return draw(row, {}, {path + ends, path + (bar ? ".bar=true" : ".bar=false")});
    };
    for (const bool bar : {true, false}) {
      const std::vector<Image> right = drawn(1, bar);
      for (const double factor : {1.02, 0.98}) {
        const std::vector<Image> wrong = drawn(factor, bar);
        for (std::size_t k = 0; k < right.size(); ++k)
          EXPECT_EQ(unseen(right[k], wrong[k], row.tolerance), "")
              << row.pictureName(row.times[k]) << ", " << path << " times " << factor
              << (bar ? " with" : " without") << " its colour bar";
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sensitivity, Range, testing::ValuesIn(rowsWith(hasField)), nameOfRow);

// --- layers of bodies

bool showsBodies(const LayerSpec& layer) {
  return layer.shown && layer.kind >= LayerKind::bodies && layer.kind <= LayerKind::collisions;
}

bool hasBodies(const SceneSpec& spec) {
  return std::any_of(spec.view.layers.begin(), spec.view.layers.end(), showsBodies);
}

std::vector<Row> rowsOfBodies() {
  std::vector<Row> found = rowsWith(hasBodies);
  std::erase_if(found, [](const Row& row) { return !row.scene.starts_with("tests/"); });
  return found;
}

std::size_t bodiesOf(const Row& row) {
  const std::vector<BodySpec> bodies = row.document().spec().bodies;
  return std::count_if(bodies.begin(), bodies.end(), [](const BodySpec& body) { return !body.particle; });
}

class Layers : public testing::TestWithParam<Row> {};

TEST_P(Layers, LeftOutIsSeen) {
  // Truth: without any one of its layers of bodies, springs and the like, a picture is beyond the tolerance
  // at one of the row's times at least; so it is without the marks of bodies.
  const Row& row = GetParam();
  const std::vector<Image> with = draw(row, {});
  const auto expectSeen = [&](const std::string& setting) {
    const std::vector<Image> without = draw(row, {}, {setting});
    bool seen = false;
    for (std::size_t k = 0; k < with.size(); ++k) seen |= unseen(with[k], without[k], row.tolerance).empty();
    EXPECT_TRUE(seen) << row.name << " with " << setting;
  };
  for (const LayerSpec& layer : row.document().spec().view.layers) {
    if (!showsBodies(layer)) continue;
    const std::string path = std::string("view.layers.") + layerName(layer.kind);
    expectSeen(path + ".opacity=0");
    constexpr std::size_t kMany = 10;
    if (layer.kind == LayerKind::bodies && bodiesOf(row) >= kMany) expectSeen(path + ".mark=false");
  }
}

INSTANTIATE_TEST_SUITE_P(Sensitivity, Layers, testing::ValuesIn(rowsOfBodies()), nameOfRow);

}  // namespace
}  // namespace smokebox::golden
