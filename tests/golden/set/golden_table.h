// The table of golden images: what is drawn, and when.
#pragma once
#include <array>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "image/difference.h"
#include "scene/document.h"

namespace smokebox::golden {

struct Row {
  std::string name;
  std::string scene;          // from the root of the repository
  std::vector<double> times;  // s
  std::optional<std::array<int, 2>> size;
  std::vector<std::string> settings;  // "key=value", laid over the scene
  DifferenceTolerance tolerance;
  std::string because;  // why the tolerance is looser than elsewhere; empty: it is not

  std::filesystem::path scenePath() const;
  /// "wake-1.50".
  std::string pictureName(double time) const;
  std::filesystem::path image(double time) const;
  /// The scene as the program sees it, settings and size laid over it.
  SceneDocument document() const;
  /// The frame of each time. Throws if one falls between two frames.
  std::vector<long> frames() const;
};
std::ostream& operator<<(std::ostream& out, const Row& row);  // its name

std::filesystem::path root();    // of the repository
std::filesystem::path images();  // the folder of the golden images

/// Throws std::runtime_error with the line for a key that is unknown, missing or wrong.
std::vector<Row> readTable(const std::filesystem::path& file);
/// The table of this repository; no rows if it cannot be read, for which there is a test of its own.
std::vector<Row> rows();

/// For the names of parameterised tests, which take letters and digits only.
std::string testName(std::string name);

}  // namespace smokebox::golden
