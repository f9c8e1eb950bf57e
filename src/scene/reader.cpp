#include "scene/reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "scene/nearest.h"

namespace smokebox {
namespace {

std::string got(const YamlNode& node) { return ", got " + node.description(); }

/// A plain decimal number, by the rules of no locale; `010` is ten.
std::optional<double> decimal(const std::string& text) {
  const char* first = text.data();
  const char* last = first + text.size();
  if (first != last && *first == '+') ++first;
  double value = 0;
  const auto [end, fault] = std::from_chars(first, last, value);
  if (fault != std::errc() || end != last || !std::isfinite(value)) return {};
  return value;
}

bool isNotANumber(const std::string& text) {
  std::string word;
  for (char c : text)
    if (c != '.' && c != '+' && c != '-')
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word == "nan" || word == "inf" || word == "infinity";
}

}  // namespace

std::string inside(const std::string& outer, const std::string& key) {
  return outer.empty() ? key : outer + "." + key;
}

void Reader::error(const YamlMark& mark, std::string message, std::string hint) {
  problems_.push_back({mark.place(), std::move(message), std::move(hint), false});
  ++errors_;
}

void Reader::warning(const YamlMark& mark, std::string message, std::string hint) {
  problems_.push_back({mark.place(), std::move(message), std::move(hint), true});
}

std::optional<double> Reader::number(const YamlNode& node, const std::string& name, const NumberRule& rule) {
  if (node.kind != YamlNode::Kind::scalar) {
    error(node.mark, "`" + name + "` must be a number" + got(node));
    return {};
  }
  std::optional<double> value = decimal(node.text);
  if (!value) {
    if (isNotANumber(node.text)) {
      error(node.mark, "`" + name + "` must be a finite number" + got(node));
      return {};
    }
    try {
      value = Expression::parse(node.text, "")(0, 0, 0);
    } catch (const std::invalid_argument& fault) {
      error(node.mark, "`" + name + "` must be a number" + got(node), fault.what());
      return {};
    }
    if (!std::isfinite(*value)) {
      error(node.mark, "`" + name + "` does not come out as a finite number" + got(node));
      return {};
    }
  }
  if (*value < rule.least || *value > rule.most || (*value == rule.least && !rule.leastAllowed)) {
    error(node.mark, "`" + name + "` must be " + rule.says + got(node));
    return {};
  }
  return value;
}

std::optional<long> Reader::whole(const YamlNode& node, const std::string& name, long least, long most) {
  const std::optional<double> value = number(node, name);
  if (!value) return {};
  if (*value != std::floor(*value) || *value < static_cast<double>(least) ||
      *value > static_cast<double>(most)) {
    error(node.mark, "`" + name + "` must be a whole number between " + std::to_string(least) + " and " +
                         std::to_string(most) + got(node));
    return {};
  }
  return static_cast<long>(*value);
}

bool Reader::isList(const YamlNode& node, const std::string& name, std::optional<std::size_t> count) {
  const std::string wanted = count ? "a list of " + std::to_string(*count) : "a list";
  if (node.kind != YamlNode::Kind::list) {
    error(node.mark, "`" + name + "` must be " + wanted + got(node));
    return false;
  }
  if (count && node.items.size() != *count) {
    error(node.mark,
          "`" + name + "` must be " + wanted + ", got one of " + std::to_string(node.items.size()));
    return false;
  }
  return true;
}

std::optional<Vec2> Reader::vector(const YamlNode& node, const std::string& name, const NumberRule& rule) {
  if (node.kind != YamlNode::Kind::list || node.items.size() != 2) {
    const std::string what = node.kind == YamlNode::Kind::list
                                 ? ", got a list of " + std::to_string(node.items.size())
                                 : got(node);
    error(node.mark, "`" + name + "` must be two numbers, [x, y]" + what);
    return {};
  }
  const auto x = number(*node.items[0], name + ".0", rule), y = number(*node.items[1], name + ".1", rule);
  if (!x || !y) return {};
  return Vec2{*x, *y};
}

std::optional<bool> Reader::boolean(const YamlNode& node, const std::string& name) {
  if (node.kind == YamlNode::Kind::scalar) {
    if (node.text == "true" || node.text == "yes" || node.text == "on") return true;
    if (node.text == "false" || node.text == "no" || node.text == "off") return false;
  }
  error(node.mark, "`" + name + "` must be true or false" + got(node));
  return {};
}

std::optional<std::string> Reader::text(const YamlNode& node, const std::string& name) {
  if (node.kind == YamlNode::Kind::scalar) return node.text;
  error(node.mark, "`" + name + "` must be a text" + got(node));
  return {};
}

std::optional<Color> Reader::color(const YamlNode& node, const std::string& name) {
  if (node.kind == YamlNode::Kind::scalar)
    if (const auto color = parseColor(node.text)) return color;
  const std::string hint = node.kind == YamlNode::Kind::null
                               ? "a # starts a comment; put the colour in quotes"
                               : "\"#rrggbb\", \"#rgb\" or a name such as orange";
  error(node.mark, "`" + name + "` must be a colour" + got(node), hint);
  return {};
}

std::optional<Expression> Reader::expression(const YamlNode& node, const std::string& name,
                                             const std::string& variables) {
  if (node.kind != YamlNode::Kind::scalar) {
    error(node.mark, "`" + name + "` must be a number or an expression" + got(node));
    return {};
  }
  if (const auto value = decimal(node.text)) return Expression(*value);
  try {
    if (isNotANumber(node.text)) throw std::invalid_argument(node.description() + " is not a finite number");
    Expression result = Expression::parse(node.text, variables);
    if (result.isConstant() && !std::isfinite(result(0, 0, 0)))
      throw std::invalid_argument(node.description() + " does not come out as a finite number");
    return result;
  } catch (const std::invalid_argument& fault) {
    error(node.mark, "`" + name + "`: " + fault.what());
    return {};
  }
}

std::optional<std::array<Expression, 2>> Reader::expressions(const YamlNode& node, const std::string& name,
                                                             const std::string& variables) {
  if (!isList(node, name, 2)) return {};
  const auto x = expression(*node.items[0], name + ".0", variables);
  const auto y = expression(*node.items[1], name + ".1", variables);
  if (!x || !y) return {};
  return std::array<Expression, 2>{*x, *y};
}

// --- maps
// -----------------------------------------------------------------------------------------------------------------
MapReader::MapReader(Reader& reader, const YamlNode& node, std::string name)
    : reader_(reader), node_(node), name_(std::move(name)) {
  isMap_ = node.kind == YamlNode::Kind::map;
  if (!isMap_ && node.kind != YamlNode::Kind::null)
    reader.error(node.mark, "`" + name_ + "` must be a map of keys and values" + got(node));
}

const YamlNode* MapReader::find(const std::string& key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.push_back(key);
  const YamlEntry* entry = node_.entry(key);
  return entry && entry->value->kind != YamlNode::Kind::null ? entry->value.get() : nullptr;
}

const YamlMark& MapReader::keyMark(const std::string& key) const {
  const YamlEntry* entry = node_.entry(key);
  return entry ? entry->mark : node_.mark;
}

bool MapReader::has(const std::string& key) const { return node_.entry(key) != nullptr; }

bool MapReader::number(const std::string& key, double& value, const NumberRule& rule) {
  const YamlNode* node = find(key);
  if (!node) return false;
  const auto read = reader_.number(*node, inside(name_, key), rule);
  if (read) value = *read;
  return read.has_value();
}

bool MapReader::whole(const std::string& key, int& value, long least, long most) {
  const YamlNode* node = find(key);
  if (!node) return false;
  const auto read = reader_.whole(*node, inside(name_, key), least, most);
  if (read) value = static_cast<int>(*read);
  return read.has_value();
}

bool MapReader::vector(const std::string& key, Vec2& value, const NumberRule& rule) {
  const YamlNode* node = find(key);
  if (!node) return false;
  const auto read = reader_.vector(*node, inside(name_, key), rule);
  if (read) value = *read;
  return read.has_value();
}

bool MapReader::boolean(const std::string& key, bool& value) {
  const YamlNode* node = find(key);
  if (!node) return false;
  const auto read = reader_.boolean(*node, inside(name_, key));
  if (read) value = *read;
  return read.has_value();
}

bool MapReader::text(const std::string& key, std::string& value) {
  const YamlNode* node = find(key);
  if (!node) return false;
  const auto read = reader_.text(*node, inside(name_, key));
  if (read) value = *read;
  return read.has_value();
}

bool MapReader::color(const std::string& key, Color& value) {
  std::optional<Color> read;
  if (!color(key, read)) return false;
  value = *read;
  return true;
}

bool MapReader::color(const std::string& key, std::optional<Color>& value) {
  find(key);
  const YamlEntry* entry = node_.entry(key);
  if (!entry) return false;
  const auto read = reader_.color(*entry->value, inside(name_, key));  // null too: a forgotten pair of quotes
  if (read) value = read;
  return read.has_value();
}

const YamlNode* MapReader::required(const std::string& key, const std::string& hint) {
  const YamlNode* node = find(key);
  if (!node && (isMap_ || node_.kind == YamlNode::Kind::null))
    reader_.error(keyMark(key), "`" + inside(name_, key) + "` is missing", hint);
  return node;
}

bool MapReader::hasMore() const {
  return std::any_of(node_.entries.begin(), node_.entries.end(), [&](const YamlEntry& entry) {
    return std::find(asked_.begin(), asked_.end(), entry.key) == asked_.end();
  });
}

void MapReader::finish() {
  for (const YamlEntry& entry : node_.entries) {
    const std::string where = name_.empty() ? "" : " in `" + name_ + "`";
    if (std::find(asked_.begin(), asked_.end(), entry.key) != asked_.end()) continue;
    reader_.error(entry.mark, "unknown key `" + entry.key + "`" + where, suggestion(entry.key, asked_));
  }
}

}  // namespace smokebox
