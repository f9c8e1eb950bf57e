// Reads values out of the tree. Whatever is wrong becomes a problem with its place, and reading goes on with
// a default, so that one run finds everything.
#pragma once
#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/color.h"
#include "base/errors.h"
#include "geometry/vec2.h"
#include "scene/expression.h"
#include "scene/yaml_tree.h"

namespace smokebox {

/// What a number must satisfy; `says` completes "must be ...".
struct NumberRule {
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  bool leastAllowed = true;
  const char* says = "a number";
};
constexpr NumberRule kAnyNumber{};
constexpr NumberRule kPositive{0, std::numeric_limits<double>::infinity(), false, "larger than 0"};
constexpr NumberRule kNotNegative{0, std::numeric_limits<double>::infinity(), true, "0 or larger"};
constexpr NumberRule kShare{0, 1, true, "between 0 and 1"};

class Reader {
 public:
  explicit Reader(std::vector<Problem>& problems) : problems_(problems) {}

  void error(const YamlMark& mark, std::string message, std::string hint = {});
  void warning(const YamlMark& mark, std::string message, std::string hint = {});
  std::size_t errors() const { return errors_; }

  // `name` is how messages call the value, in backquotes. Nothing comes back if the value is wrong (and
  // reported).
  std::optional<double> number(const YamlNode& node, const std::string& name,
                               const NumberRule& rule = kAnyNumber);
  std::optional<long> whole(const YamlNode& node, const std::string& name, long least, long most);
  std::optional<Vec2> vector(const YamlNode& node, const std::string& name,
                             const NumberRule& rule = kAnyNumber);
  std::optional<bool> boolean(const YamlNode& node, const std::string& name);
  std::optional<std::string> text(const YamlNode& node, const std::string& name);
  std::optional<Color> color(const YamlNode& node, const std::string& name);
  std::optional<Expression> expression(const YamlNode& node, const std::string& name,
                                       const std::string& variables);
  std::optional<std::array<Expression, 2>> expressions(const YamlNode& node, const std::string& name,
                                                       const std::string& variables);
  /// Reports anything but a list (of `count` items, if that is given).
  bool isList(const YamlNode& node, const std::string& name, std::optional<std::size_t> count = {});

 private:
  std::vector<Problem>& problems_;
  std::size_t errors_ = 0;
};

/// A map whose keys are asked for one by one; finish() reports those that nobody asked for.
class MapReader {
 public:
  /// Reports a node that is no map; nothing at all (`fluid:`) counts as an empty one.
  MapReader(Reader& reader, const YamlNode& node, std::string name);

  Reader& reader() { return reader_; }
  const YamlNode& node() const { return node_; }
  const YamlMark& mark() const { return node_.mark; }
  const std::string& name() const { return name_; }
  bool isMap() const { return isMap_; }
  /// Neither a map nor nothing at all: has been reported.
  bool isWrong() const { return !isMap_ && node_.kind != YamlNode::Kind::null; }

  /// The value of a key, nullptr if it is missing or null.
  const YamlNode* find(const std::string& key);
  /// Place of the key, of the map if it is missing.
  const YamlMark& keyMark(const std::string& key) const;
  bool has(const std::string& key) const;

  // Each overwrites `value` only if the key is there and right; true if it did.
  bool number(const std::string& key, double& value, const NumberRule& rule = kAnyNumber);
  bool whole(const std::string& key, int& value, long least, long most);
  bool vector(const std::string& key, Vec2& value, const NumberRule& rule = kAnyNumber);
  bool boolean(const std::string& key, bool& value);
  bool text(const std::string& key, std::string& value);
  bool color(const std::string& key, Color& value);
  bool color(const std::string& key, std::optional<Color>& value);

  /// Reports a key that has to be there.
  const YamlNode* required(const std::string& key, const std::string& hint = {});
  /// Is there a key that nobody has asked for yet?
  bool hasMore() const;
  /// Reports every key that was not asked for.
  void finish();

 private:
  Reader& reader_;
  const YamlNode& node_;
  std::string name_;
  bool isMap_ = false;
  std::vector<std::string> asked_;
};

/// `a.b` in the words of messages: the name of `key` within `outer`.
std::string inside(const std::string& outer, const std::string& key);

}  // namespace smokebox
