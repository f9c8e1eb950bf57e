// A YAML document as a tree whose every node knows its place, built from the events of yaml-cpp's parser.
//
// yaml-cpp's own nodes lose what an error message needs: they take a second key of the same name silently,
// give no place for what is missing, and read `010` as 8. Nodes here are never changed once built; aliases
// share them, and an override copies only the nodes on its path. Limits: 64 levels, a million nodes with
// every alias written out.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"

namespace smokebox {

struct YamlNode;
using YamlPtr = std::shared_ptr<const YamlNode>;

struct YamlMark {
  std::shared_ptr<const std::string> file;
  int line = 0, column = 0;  // from 1
  SourcePlace place() const { return {file ? *file : std::string(), line, column}; }
};

struct YamlEntry {
  std::string key;
  YamlMark mark;  // of the key
  YamlPtr value;
};

struct YamlNode {
  enum class Kind { null, scalar, list, map };
  Kind kind = Kind::null;
  YamlMark mark;
  bool quoted = false;             // a scalar in quotes is always text
  std::string text;                // of a scalar
  std::vector<YamlPtr> items;      // of a list
  std::vector<YamlEntry> entries;  // of a map, in the order of the file, each key once
  std::size_t total = 1;           // nodes in all, aliases written out
  int depth = 1;                   // levels

  const YamlEntry* entry(std::string_view key) const;
  /// "a list", "a map", "the text `abc`", "nothing": how messages speak of it.
  std::string description() const;
};

/// Parses one document. Throws SceneError on what is no YAML, or breaks a limit; keys that are given twice
/// are added to `problems` (the first one counts). A null node stands for a document without content.
YamlPtr parseYaml(std::string_view text, const std::string& file, std::vector<Problem>& problems);

/// The same for a single value of an override, all of whose nodes get the same place.
YamlPtr parseYamlValue(std::string_view text, const SourcePlace& place);

/// The node as one line of YAML.
std::string yamlText(const YamlNode& node);

/// Recounts `total` and `depth` of a list or map that was put together by hand.
void recount(YamlNode& node);

}  // namespace smokebox
