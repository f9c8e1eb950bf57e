#include "scene/document.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/hash.h"
#include "scene/sections.h"
#include "scene/tree_path.h"
#include "scene/yaml_tree.h"

namespace smokebox {

struct SceneDocument::Tree {
  YamlPtr root;
  std::string name;               // of the scene
  std::vector<Problem> problems;  // of the text itself
  Fnv1a hash;
};

namespace {

constexpr std::size_t kLargestFile = 8u << 20;

std::string readWhole(const std::filesystem::path& file) {
  std::error_code fault;
  if (std::filesystem::is_directory(file, fault))
    throw IoError(file.string() + ": is a directory, not a scene file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), std::fclose);
  if (!stream) throw IoError(file.string() + ": cannot be read: " + std::strerror(errno));
  std::string text;
  char buffer[1 << 16];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, stream.get())) {
    text.append(buffer, count);
    if (text.size() > kLargestFile) break;  // parse() refuses it
  }
  if (std::ferror(stream.get())) throw IoError(file.string() + ": cannot be read: " + std::strerror(errno));
  return text;
}

bool before(const Problem& a, const Problem& b) {
  if (a.place.line != b.place.line) return a.place.line < b.place.line;
  return a.place.column < b.place.column;
}

}  // namespace

SceneDocument SceneDocument::load(const std::filesystem::path& file) {
  return parse(readWhole(file), file.string());
}

SceneDocument SceneDocument::parse(std::string_view text, const std::string& name) {
  auto fail = [&](const std::string& message, const std::string& hint) {
    throw SceneError({Problem{{name, 1, 1}, message, hint, false}});
  };
  if (text.size() > kLargestFile) fail("a scene file must not be larger than 8 MiB", "");
  if (text.find('\0') != std::string_view::npos) fail("not YAML: the file holds bytes that are no text", "");
  auto tree = std::make_shared<Tree>();
  tree->name = std::filesystem::path(name).stem().string();
  tree->root = parseYaml(text, name, tree->problems);
  if (tree->root->kind == YamlNode::Kind::null) fail("the file is empty", "a scene needs at least `domain`");
  if (tree->root->kind != YamlNode::Kind::map)
    throw SceneError(
        {Problem{tree->root->mark.place(),
                 "a scene must be a map of keys and values, got " + tree->root->description(), "", false}});
  tree->hash.update(text);
  SceneDocument document;
  document.tree_ = std::move(tree);
  return document;
}

void SceneDocument::set(const std::string& path, const std::string& value, const SourcePlace& place) {
  auto tree = std::make_shared<Tree>(*tree_);  // other copies of this document keep theirs
  tree->root = withValue(tree->root, path, parseYamlValue(value, place), place);
  tree->hash.update("\n" + path + "=" + value);
  tree_ = std::move(tree);
}

std::vector<Problem> SceneDocument::problems() const {
  std::vector<Problem> problems = tree_->problems;
  readScene(tree_->root, tree_->name, problems);
  std::stable_sort(problems.begin(), problems.end(), before);
  // A part that aliases repeat is wrong once.
  std::vector<Problem> once;
  for (Problem& problem : problems)
    if (once.empty() || once.back().text() != problem.text()) once.push_back(std::move(problem));
  return once;
}

SceneSpec SceneDocument::spec() const {
  std::vector<Problem> problems = tree_->problems;
  SceneSpec spec = readScene(tree_->root, tree_->name, problems);
  if (std::any_of(problems.begin(), problems.end(),
                  [](const Problem& problem) { return !problem.warning; })) {
    std::vector<Problem> errors = this->problems();
    std::erase_if(errors, [](const Problem& problem) { return problem.warning; });
    throw SceneError(std::move(errors));
  }
  return spec;
}

std::string SceneDocument::hash() const { return tree_->hash.text(); }

}  // namespace smokebox
