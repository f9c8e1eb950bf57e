// The runs of a comparison: one scene under every combination of the values that `--vary` gives.
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "scene/document.h"

namespace smokebox {

/// One of the runs: what is set, and how its panel is called.
struct Variant {
  std::vector<std::pair<std::string, std::string>> settings;  // key and value
  std::string label;                                          // "fluid.vorticity = 0.35"
};

constexpr int kFewestVariants = 2, kMostVariants = 9;

/// `varied`: "KEY=V1,V2,...", one for each --vary; commas within brackets, braces or quotes part no values.
/// The first key changes slowest. Throws UsageError: nothing to compare, more than nine runs, a key twice.
std::vector<Variant> variantsOf(const std::vector<std::string>& varied);

/// What stands above the panels, with all values in it: the labels; if they do not fit, with the last step of
/// each key ("vorticity = 0.35"); if these do not fit either, or two keys end alike, the values alone.
std::vector<std::string> panelLabels(const std::vector<Variant>& variants,
                                     const std::function<bool(const std::vector<std::string>&)>& fit);

/// The scene of each. Throws SceneError for values that the scene does not take; UsageError if their films
/// would not go in step: another frame rate, number of frames or size of picture.
std::vector<SceneDocument> variantScenes(const SceneDocument& scene, const std::vector<Variant>& variants);

}  // namespace smokebox
