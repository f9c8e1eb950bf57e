// The architecture, checked against the sources: a folder includes only what its arrows allow, and each
// third-party library is used in one folder.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace smokebox {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>> kArrows = {
    {"base", {}},
    {"geometry", {"base"}},
    {"scene", {"geometry", "base"}},
    {"fluid", {"geometry", "base"}},
    {"rigid", {"geometry", "base"}},
    {"coupling", {"fluid", "rigid", "geometry", "base"}},
    {"baseline", {"fluid", "rigid", "geometry", "base"}},
    {"world", {"scene", "coupling", "baseline", "fluid", "rigid", "geometry", "base"}},
    {"image", {"base"}},
    {"render", {"world", "image", "scene", "geometry", "base"}},
    {"video", {"image", "base"}},
    {"study", {"world", "image", "scene", "geometry", "base"}},
    {"app",
     {"study", "video", "render", "world", "image", "scene", "coupling", "baseline", "fluid", "rigid",
      "geometry", "base"}},
};

/// Beginning of the included name, and the one folder that may use it.
const std::map<std::string, std::string> kLibraries = {
    {"CLI/", "app"},
    {"nlohmann/", "app"},
    {"yaml-cpp/", "scene"},
    {"muParser", "scene"},
    {"GL/", "render"},
    {"EGL/", "render"},
    {"libav", "video"},
    {"libsw", "video"},
    {"png.h", "image"},
    {"ft2build", "image"},
    {"freetype/", "image"},
    {"zlib.h", "image"},
    {"polyclipping/", "geometry"},
};

struct Include {
  std::string folder, file, name;  // of the including file; what it includes
  bool quoted = false;
};

std::vector<Include> allIncludes() {
  std::vector<Include> includes;
  const fs::path source = fs::path(SMOKEBOX_SOURCE_DIR) / "src";
  const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  for (const auto& entry : fs::recursive_directory_iterator(source)) {
    const std::string extension = entry.path().extension();
    if (extension != ".h" && extension != ".cpp") continue;
    const fs::path relative = fs::relative(entry.path(), source);
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      std::smatch match;
      if (std::regex_search(line, match, pattern))
        includes.push_back({relative.begin()->string(), relative.string(), match[2], match[1] == "\""});
    }
  }
  return includes;
}

TEST(IncludeArrows, PointOnlyWhereTheDesignSays) {
  // A folder includes its own headers and those that its arrows lead to, by their path from src.
  const std::vector<Include> includes = allIncludes();
  ASSERT_GT(includes.size(), 100u);
  for (const Include& include : includes) {
    if (!include.quoted) continue;
    ASSERT_TRUE(kArrows.contains(include.folder))
        << include.file << " is in a folder that the design does not have";
    const std::string target = include.name.substr(0, include.name.find('/'));
    EXPECT_TRUE(target == include.folder || kArrows.at(include.folder).contains(target))
        << include.file << " includes " << include.name;
  }
}

TEST(IncludeArrows, EachLibraryIsUsedInOneFolder) {
  // What wraps a third-party library is in one place.
  for (const Include& include : allIncludes()) {
    if (include.quoted) continue;
    for (const auto& [library, folder] : kLibraries) {
      if (include.name.starts_with(library)) {
        EXPECT_EQ(include.folder, folder) << include.file << " includes " << include.name;
      }
    }
  }
}

TEST(IncludeArrows, HaveNoCycle) {
  // The table itself is sound: taking away again and again the folders that include no other leaves none.
  std::map<std::string, std::set<std::string>> left = kArrows;
  for (bool taken = true; taken;) {
    taken = false;
    for (auto folder = left.begin(); folder != left.end(); ++folder) {
      if (!folder->second.empty()) continue;
      for (auto& [other, targets] : left) targets.erase(folder->first);
      left.erase(folder);
      taken = true;
      break;
    }
  }
  for (const auto& [folder, targets] : left) ADD_FAILURE() << folder << " is in a cycle";
}

}  // namespace
}  // namespace smokebox
