#include "scene/yaml_tree.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <sstream>
#include <unordered_map>
#include <unordered_set>

namespace smokebox {
namespace {

constexpr int kDeepest = 64;
constexpr std::size_t kMostNodes = 1000000;

[[noreturn]] void fail(const YamlMark& mark, std::string message, std::string hint = {}) {
  throw SceneError({Problem{mark.place(), std::move(message), std::move(hint), false}});
}

/// Builds the tree from the parser's events.
class Builder : public YAML::EventHandler {
 public:
  Builder(std::shared_ptr<const std::string> file, const SourcePlace* fixed, std::vector<Problem>& problems)
      : file_(std::move(file)), fixed_(fixed), problems_(problems) {}

  YamlPtr root() const { return root_; }
  YamlMark markAt(const YAML::Mark& mark) const {
    if (fixed_) return {file_, fixed_->line, fixed_->column};
    return mark.is_null() ? YamlMark{file_, 0, 0} : YamlMark{file_, mark.line + 1, mark.column + 1};
  }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    auto node = newNode(mark, YamlNode::Kind::null);
    // Nothing stands there: the parser's place is that of whatever comes next.
    if (!stack_.empty() && stack_.back().key) node->mark = stack_.back().key->mark;
    finish(std::move(node), anchor);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    auto node = newNode(mark, YamlNode::Kind::scalar);
    node->text = value;
    node->quoted = tag == "!";
    finish(std::move(node), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto known = anchors_.find(anchor);
    if (known == anchors_.end()) fail(markAt(mark), "an alias stands inside of what it is an alias for");
    add(known->second, markAt(mark));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(newNode(mark, YamlNode::Kind::list), anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(newNode(mark, YamlNode::Kind::map), anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    std::shared_ptr<YamlNode> node;
    YAML::anchor_t anchor;
    std::optional<YamlEntry> key;                         // of a map: waits for its value
    std::unordered_map<std::string, std::size_t> places;  // of a map: its keys so far
  };

  std::shared_ptr<YamlNode> newNode(const YAML::Mark& mark, YamlNode::Kind kind) const {
    auto node = std::make_shared<YamlNode>();
    node->kind = kind;
    node->mark = markAt(mark);
    return node;
  }

  void open(std::shared_ptr<YamlNode> node, YAML::anchor_t anchor) {
    if (stack_.size() >= kDeepest) tooDeep(node->mark);
    stack_.push_back({std::move(node), anchor, {}, {}});
  }

  void close() {
    Open done = std::move(stack_.back());
    stack_.pop_back();
    finish(std::move(done.node), done.anchor);
  }

  void finish(std::shared_ptr<YamlNode> node, YAML::anchor_t anchor) {
    const YamlMark mark = node->mark;
    YamlPtr done = std::move(node);
    if (anchor != YAML::NullAnchor) anchors_[anchor] = done;
    add(std::move(done), mark);
  }

  void add(YamlPtr node, const YamlMark& mark) {
    if (stack_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& parent = stack_.back();
    YamlNode& into = *parent.node;
    if (into.kind == YamlNode::Kind::map && !parent.key) {
      if (node->kind != YamlNode::Kind::scalar)
        fail(mark, "a key must be a word, got " + node->description(),
             "is a value in quotes or a space missing?");
      parent.key = YamlEntry{node->text, mark, nullptr};
      return;
    }
    into.total += node->total;
    into.depth = std::max(into.depth, node->depth + 1);
    if (into.total > kMostNodes)
      fail(mark, "more than " + std::to_string(kMostNodes) + " values when every alias is written out",
           "an alias of aliases grows without bound");
    if (into.depth + static_cast<int>(stack_.size()) - 1 > kDeepest) tooDeep(mark);
    if (into.kind == YamlNode::Kind::list) {
      into.items.push_back(std::move(node));
      return;
    }
    parent.key->value = std::move(node);
    const auto [place, fresh] = parent.places.emplace(parent.key->key, into.entries.size());
    if (fresh) {
      into.entries.push_back(std::move(*parent.key));
    } else {
      const YamlMark& first = into.entries[place->second].mark;
      problems_.push_back({parent.key->mark.place(), "the key `" + parent.key->key + "` is given twice",
                           "first at " + first.place().text(), false});
    }
    parent.key.reset();
  }

  [[noreturn]] static void tooDeep(const YamlMark& mark) {
    fail(mark, "nested deeper than " + std::to_string(kDeepest) + " levels");
  }

  std::shared_ptr<const std::string> file_;
  const SourcePlace* fixed_;
  std::vector<Problem>& problems_;
  std::vector<Open> stack_;
  std::unordered_map<YAML::anchor_t, YamlPtr> anchors_;
  YamlPtr root_;
};

YamlPtr parseWith(std::string_view text, Builder& builder) {
  std::istringstream stream{std::string(text)};
  try {
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) return std::make_shared<const YamlNode>();
    std::vector<Problem> ignored;
    Builder second(nullptr, nullptr, ignored);
    const YamlPtr first = builder.root();
    if (parser.HandleNextDocument(second) && second.root() && second.root()->kind != YamlNode::Kind::null) {
      const YamlMark at = second.root()->mark;
      fail({first->mark.file, at.line, at.column}, "a second document", "a scene is one YAML document");
    }
    return first;
  } catch (const YAML::Exception& error) {
    fail(builder.markAt(error.mark), "not YAML: " + error.msg);
  }
}

}  // namespace

const YamlEntry* YamlNode::entry(std::string_view key) const {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const YamlEntry& e) { return e.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

std::string YamlNode::description() const {
  constexpr std::size_t kLongest = 40;
  switch (kind) {
    case Kind::null:
      return "nothing";
    case Kind::list:
      return "a list";
    case Kind::map:
      return "a map";
    case Kind::scalar:
      break;
  }
  return "`" + text.substr(0, kLongest) + (text.size() > kLongest ? "...`" : "`");
}

YamlPtr parseYaml(std::string_view text, const std::string& file, std::vector<Problem>& problems) {
  Builder builder(std::make_shared<const std::string>(file), nullptr, problems);
  return parseWith(text, builder);
}

YamlPtr parseYamlValue(std::string_view text, const SourcePlace& place) {
  std::vector<Problem> problems;
  auto file = std::make_shared<const std::string>(place.file);
  Builder builder(file, &place, problems);
  YamlPtr root = parseWith(text, builder);
  if (!problems.empty()) throw SceneError(problems);
  if (root->kind == YamlNode::Kind::null) {  // an empty text has no node with a place
    YamlNode empty;
    empty.mark = {file, place.line, place.column};
    return std::make_shared<const YamlNode>(std::move(empty));
  }
  return root;
}

namespace {
/// Can the word stand without quotes and mean the same?
bool isPlain(const std::string& word) {
  return !word.empty() && word != "-" && std::all_of(word.begin(), word.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) ||
           std::string_view("_.+-/^()").find(c) != std::string_view::npos;
  });
}
}  // namespace

std::string yamlText(const YamlNode& node) {
  std::string text;
  auto quote = [&](const std::string& word) {
    text += '"';
    for (char c : word) {
      if (c == '"' || c == '\\') text += '\\';
      if (c == '\n') {
        text += "\\n";
      } else if (c == '\t') {
        text += "\\t";
      } else {
        text += c;
      }
    }
    text += '"';
  };
  switch (node.kind) {
    case YamlNode::Kind::null:
      return "~";
    case YamlNode::Kind::scalar:
      if (!node.quoted && isPlain(node.text)) return node.text;
      quote(node.text);
      return text;
    case YamlNode::Kind::list:
      text += '[';
      for (std::size_t k = 0; k < node.items.size(); ++k) text += (k ? ", " : "") + yamlText(*node.items[k]);
      return text + ']';
    case YamlNode::Kind::map:
      text += '{';
      for (std::size_t k = 0; k < node.entries.size(); ++k) {
        if (k) text += ", ";
        quote(node.entries[k].key);
        text += ": " + yamlText(*node.entries[k].value);
      }
      return text + '}';
  }
  return text;
}

void recount(YamlNode& node) {
  node.total = 1;
  node.depth = 1;
  auto count = [&](const YamlNode& child) {
    node.total += child.total;
    node.depth = std::max(node.depth, child.depth + 1);
  };
  for (const YamlPtr& item : node.items) count(*item);
  for (const YamlEntry& entry : node.entries) count(*entry.value);
}

}  // namespace smokebox
