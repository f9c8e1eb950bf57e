#include "image/colormap.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

namespace {
// Blue, neutral, red; the ends glow.
const ColorMap kPressureDark{true,
                             {{{0.1700f, 0.1700f, 0.1700f},
                               {1.2930f, 0.3535f, -0.0357f},
                               {-1.0917f, -4.1002f, -1.1362f},
                               {1.2682f, 12.9846f, 3.0700f},
                               {5.1194f, -14.4599f, -2.9295f},
                               {-11.3999f, 7.4531f, 3.2868f},
                               {5.6410f, -1.5411f, -1.7453f}}},
                             {{{0.1700f, 0.1700f, 0.1700f},
                               {-0.0230f, 0.5903f, 1.2389f},
                               {-1.6168f, -3.5703f, 0.1365f},
                               {6.0936f, 12.8385f, -2.2778f},
                               {-8.5358f, -15.6304f, 9.2933f},
                               {7.6480f, 7.5744f, -13.8094f},
                               {-2.9761f, -1.0424f, 6.2485f}}}};
// Blue, neutral, red; the ends are deep.
const ColorMap kPressureLight{true,
                              {{{0.9300f, 0.9300f, 0.9300f},
                                {0.1593f, -0.7164f, -1.0566f},
                                {-0.6569f, 0.8891f, -0.1730f},
                                {1.1374f, -2.2623f, 1.5747f},
                                {-0.1462f, -2.9478f, -4.8852f},
                                {-3.0286f, 8.6978f, 6.6859f},
                                {2.1050f, -4.5505f, -2.9557f}}},
                              {{{0.9300f, 0.9300f, 0.9300f},
                                {-0.9113f, -0.4878f, 0.0726f},
                                {1.8880f, 1.8038f, 0.4008f},
                                {-7.3826f, -7.8384f, -3.1336f},
                                {8.7912f, 11.2493f, 7.0850f},
                                {-2.8529f, -7.2182f, -8.4979f},
                                {-0.3824f, 1.7613f, 3.6432f}}}};
// Green, neutral, violet; the ends glow.
const ColorMap kVorticityDark{true,
                              {{{0.1700f, 0.1700f, 0.1700f},
                                {0.7547f, 0.2977f, 1.0352f},
                                {-1.2831f, -3.2516f, -0.6578f},
                                {4.6803f, 11.2061f, 1.3459f},
                                {-4.1467f, -14.1079f, 2.9133f},
                                {-0.4705f, 8.9026f, -7.9710f},
                                {1.2553f, -2.3769f, 4.1643f}}},
                              {{{0.1700f, 0.1700f, 0.1700f},
                                {-0.4156f, 0.6762f, 0.4220f},
                                {5.6449f, -2.1252f, -1.0677f},
                                {-37.3205f, 8.1704f, 4.9552f},
                                {86.4231f, -9.0817f, -7.8369f},
                                {-79.4226f, 2.6661f, 5.8798f},
                                {25.7208f, 0.5041f, -1.7224f}}}};
// Green, neutral, violet; the ends are deep.
const ColorMap kVorticityLight{true,
                               {{{0.9300f, 0.9300f, 0.9300f},
                                 {-0.3785f, -0.7652f, -0.1944f},
                                 {1.5625f, 1.6177f, 1.7053f},
                                 {-7.3083f, -6.3547f, -8.0955f},
                                 {11.9589f, 7.2063f, 13.1730f},
                                 {-9.5321f, -2.1007f, -10.3765f},
                                 {3.0275f, -0.4834f, 3.2383f}}},
                               {{{0.9300f, 0.9300f, 0.9300f},
                                 {-0.8037f, -0.2748f, -0.7316f},
                                 {1.3848f, 2.1009f, 0.9662f},
                                 {-3.6541f, -9.8425f, -4.3151f},
                                 {-3.2905f, 16.0652f, 6.7497f},
                                 {11.5382f, -12.6324f, -4.6575f},
                                 {-6.0847f, 3.9337f, 1.2183f}}}};
// From night blue over teal to yellow.
const ColorMap kSpeedDark{false,
                          {{{0.0700f, 0.0600f, 0.1700f},
                            {0.7683f, 0.1239f, 1.5497f},
                            {2.1127f, -0.1949f, -1.0658f},
                            {-14.7883f, 13.2707f, 3.3339f},
                            {15.2743f, -33.4532f, -15.3822f},
                            {4.3733f, 31.9622f, 18.7432f},
                            {-6.8202f, -10.8488f, -6.9688f}}},
                          {{{0.0700f, 0.0600f, 0.1700f},
                            {0.7683f, 0.1239f, 1.5497f},
                            {2.1127f, -0.1949f, -1.0658f},
                            {-14.7883f, 13.2707f, 3.3339f},
                            {15.2743f, -33.4532f, -15.3822f},
                            {4.3733f, 31.9622f, 18.7432f},
                            {-6.8202f, -10.8488f, -6.9688f}}}};
// From ivory over teal to deep blue.
const ColorMap kSpeedLight{false,
                           {{{0.9600f, 0.9600f, 0.9000f},
                             {-1.6982f, -0.2714f, -0.7165f},
                             {13.6905f, 0.3336f, -1.4013f},
                             {-71.1169f, -2.7152f, 10.8246f},
                             {141.4367f, 2.3085f, -16.3207f},
                             {-121.2394f, -0.3395f, 7.3883f},
                             {38.0273f, -0.1559f, -0.3144f}}},
                           {{{0.9600f, 0.9600f, 0.9000f},
                             {-1.6982f, -0.2714f, -0.7165f},
                             {13.6905f, 0.3336f, -1.4013f},
                             {-71.1169f, -2.7152f, 10.8246f},
                             {141.4367f, 2.3085f, -16.3207f},
                             {-121.2394f, -0.3395f, 7.3883f},
                             {38.0273f, -0.1559f, -0.3144f}}}};
// From night violet over red to pale yellow.
const ColorMap kTemperatureDark{false,
                                {{{0.0706f, 0.0471f, 0.1412f},
                                  {0.8166f, 0.0768f, 1.4848f},
                                  {1.0671f, 3.4224f, -1.2355f},
                                  {9.3912f, -22.6612f, -2.4404f},
                                  {-29.7563f, 58.0999f, -10.5108f},
                                  {28.5025f, -58.0749f, 27.2584f},
                                  {-9.0916f, 20.0429f, -13.9761f}}},
                                {{{0.0706f, 0.0471f, 0.1412f},
                                  {0.8166f, 0.0768f, 1.4848f},
                                  {1.0671f, 3.4224f, -1.2355f},
                                  {9.3912f, -22.6612f, -2.4404f},
                                  {-29.7563f, 58.0999f, -10.5108f},
                                  {28.5025f, -58.0749f, 27.2584f},
                                  {-9.0916f, 20.0429f, -13.9761f}}}};
// From ivory over orange to deep violet.
const ColorMap kTemperatureLight{false,
                                 {{{0.9608f, 0.9608f, 0.9020f},
                                   {0.2241f, -0.3386f, -1.4685f},
                                   {-0.5714f, -1.4772f, -6.7243f},
                                   {-0.5170f, 0.3047f, 26.1892f},
                                   {2.9865f, -3.4072f, -32.7609f},
                                   {-6.4275f, 8.7935f, 18.1006f},
                                   {3.6229f, -4.7575f, -3.9674f}}},
                                 {{{0.9608f, 0.9608f, 0.9020f},
                                   {0.2241f, -0.3386f, -1.4685f},
                                   {-0.5714f, -1.4772f, -6.7243f},
                                   {-0.5170f, 0.3047f, 26.1892f},
                                   {2.9865f, -3.4072f, -32.7609f},
                                   {-6.4275f, 8.7935f, 18.1006f},
                                   {3.6229f, -4.7575f, -3.9674f}}}};
}  // namespace

Color ColorMap::at(double u) const {
  const auto& terms = u < 0 ? negative : positive;
  const float t = static_cast<float>(std::min(std::abs(u), 1.0));
  Color sum = terms[kTerms - 1];
  for (int k = kTerms - 2; k >= 0; --k)
    sum = {sum.r * t + terms[k].r, sum.g * t + terms[k].g, sum.b * t + terms[k].b};
  return {std::clamp(sum.r, 0.0f, 1.0f), std::clamp(sum.g, 0.0f, 1.0f), std::clamp(sum.b, 0.0f, 1.0f)};
}

const ColorMap& colorMap(ColorMapKind kind, bool darkGround) {
  switch (kind) {
    case ColorMapKind::pressure:
      return darkGround ? kPressureDark : kPressureLight;
    case ColorMapKind::vorticity:
      return darkGround ? kVorticityDark : kVorticityLight;
    case ColorMapKind::temperature:
      return darkGround ? kTemperatureDark : kTemperatureLight;
    case ColorMapKind::speed:
      break;
  }
  return darkGround ? kSpeedDark : kSpeedLight;
}

ColorMapScale colorMapScale(const std::array<double, 2>& range, bool diverging) {
  const double low = range[0], high = range[1];
  auto inverse = [](double x) { return x > 0 ? 1 / x : 0.0; };
  if (!diverging) return {low, inverse(high - low), 0};
  if (low >= 0) return {low, inverse(high - low), 0};
  if (high <= 0) return {high, 0, inverse(high - low)};
  return {0, inverse(high), inverse(-low)};
}

double colorMapPosition(double value, const std::array<double, 2>& range, bool diverging) {
  const ColorMapScale scale = colorMapScale(range, diverging);
  const double offset = value - scale.zero;
  return std::clamp(offset * (offset < 0 ? scale.below : scale.above), diverging ? -1.0 : 0.0, 1.0);
}

}  // namespace smokebox
