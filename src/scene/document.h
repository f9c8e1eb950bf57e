// A scene file: the YAML tree with its places, the overrides laid over it, and the spec that comes out.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "scene/spec.h"

namespace smokebox {

class SceneDocument {
 public:
  /// Reads and parses a file. Throws IoError (cannot be read) or SceneError (not YAML, too deep, too large,
  /// ...).
  static SceneDocument load(const std::filesystem::path& file);
  /// The same from text; `name` stands for the file in messages.
  static SceneDocument parse(std::string_view text, const std::string& name);

  /// Lays `path=value` over the tree: `fluid.vorticity=0`, `solids.fan.drag=1`, `smoke.sources.0.rate=2`. The
  /// value is YAML; maps that are missing on the way are made. Throws SceneError if a step leads nowhere (no
  /// such name or position in a list, or past a single value); unknown keys and wrong values are found, at
  /// `place`, when spec() is built.
  void set(const std::string& path, const std::string& value, const SourcePlace& place);

  /// Reads and checks everything. Throws SceneError with every error found.
  SceneSpec spec() const;
  /// Every problem, warnings too, without throwing.
  std::vector<Problem> problems() const;

  /// 64-bit hash (hexadecimal) of the file's text and the overrides, for the metadata of pictures.
  std::string hash() const;

 private:
  struct Tree;
  std::shared_ptr<Tree> tree_;
};

}  // namespace smokebox
