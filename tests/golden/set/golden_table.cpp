#include "golden/set/golden_table.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <set>
#include <stdexcept>

#include "base/errors.h"

namespace smokebox::golden {

namespace {

[[noreturn]] void fail(const YAML::Node& node, const std::string& what) {
  throw std::runtime_error("table of golden images, line " + std::to_string(node.Mark().line + 1) + ": " +
                           what);
}

void checkKeys(const YAML::Node& node, const std::set<std::string>& known) {
  for (const auto& entry : node)
    if (!known.contains(entry.first.as<std::string>()))
      fail(entry.first, "unknown key `" + entry.first.as<std::string>() + "`");
}

std::string flow(const YAML::Node& node) {
  YAML::Emitter out;
  out << YAML::Flow << node;
  return out.c_str();
}

void readTolerance(const YAML::Node& node, Row& row) {
  checkKeys(node, {"level", "pixels_off", "window_off", "window_shift", "because"});
  DifferenceTolerance& t = row.tolerance;
  t.level = node["level"].as<int>(t.level);
  t.pixelsOff = node["pixels_off"].as<double>(t.pixelsOff);
  t.windowOff = node["window_off"].as<double>(t.windowOff);
  t.windowShift = node["window_shift"].as<double>(t.windowShift);
  row.because = node["because"].as<std::string>("");
  if (row.because.empty()) fail(node, "a tolerance needs its reason, `because`");
}

Row readRow(const YAML::Node& node) {
  if (!node.IsMap()) fail(node, "a row is a map");
  checkKeys(node, {"name", "scene", "at", "size", "set", "tolerance"});
  for (const char* key : {"name", "scene", "at"})
    if (!node[key]) fail(node, std::string("a row has no `") + key + "`");
  Row row;
  row.name = node["name"].as<std::string>();
  row.scene = node["scene"].as<std::string>();
  row.times = node["at"].as<std::vector<double>>();
  if (row.times.empty()) fail(node, "`at` is empty");
  if (!std::is_sorted(row.times.begin(), row.times.end())) fail(node["at"], "times must be in order");
  if (node["size"]) row.size = node["size"].as<std::array<int, 2>>();
  for (const auto& entry : node["set"])
    row.settings.push_back(entry.first.as<std::string>() + "=" + flow(entry.second));
  if (node["tolerance"]) readTolerance(node["tolerance"], row);
  return row;
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const Row& row) { return out << row.name; }

std::filesystem::path root() { return SMOKEBOX_SOURCE_DIR; }
std::filesystem::path images() { return root() / "tests/golden/images"; }

std::filesystem::path Row::scenePath() const { return root() / scene; }

std::string Row::pictureName(double time) const {
  char text[32];
  std::snprintf(text, sizeof text, "-%.2f", time);
  return name + text;
}

std::filesystem::path Row::image(double time) const { return images() / (pictureName(time) + ".png"); }

SceneDocument Row::document() const {
  SceneDocument document = SceneDocument::load(scenePath());
  const auto lay = [&](const std::string& setting) {
    const std::size_t equals = setting.find('=');
    document.set(setting.substr(0, equals), setting.substr(equals + 1), {"--set " + setting, 0, 0});
  };
  for (const std::string& setting : settings) lay(setting);
  if (size) lay("output.size=[" + std::to_string((*size)[0]) + ", " + std::to_string((*size)[1]) + "]");
  return document;
}

std::vector<long> Row::frames() const {
  const int fps = document().spec().output.fps;
  std::vector<long> frames;
  for (const double time : times) {
    frames.push_back(std::lround(time * fps));
    if (std::fabs(time * fps - static_cast<double>(frames.back())) > 1e-6)
      throw std::runtime_error(pictureName(time) + ": there is no frame at that time, at " +
                               std::to_string(fps) + " frames a second");
  }
  return frames;
}

std::vector<Row> readTable(const std::filesystem::path& file) {
  try {
    std::vector<Row> rows;
    std::set<std::string> names;
    for (const YAML::Node& node : YAML::LoadFile(file)) {
      rows.push_back(readRow(node));
      if (!names.insert(rows.back().name).second) fail(node, "a second row `" + rows.back().name + "`");
    }
    return rows;
  } catch (const YAML::Exception& error) {
    throw std::runtime_error("table of golden images: " + std::string(error.what()));
  }
}

std::vector<Row> rows() {
  try {
    return readTable(root() / "tests/golden/table.yaml");
  } catch (const std::exception&) {
    return {};
  }
}

std::string testName(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

}  // namespace smokebox::golden
