// The table is whole: every scene that ships has a row, every row its images, every image its row.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "golden/set/golden_report.h"
#include "golden/set/golden_run.h"
#include "support/temporary_folder.h"

namespace smokebox::golden {
namespace {

namespace fs = std::filesystem;

TEST(GoldenTable, CanBeRead) {
  // Every row names a scene that is there, and times at which its film has a frame.
  std::vector<Row> table;
  ASSERT_NO_THROW(table = readTable(root() / "tests/golden/table.yaml"));
  EXPECT_FALSE(table.empty());
  for (const Row& row : table) {
    EXPECT_TRUE(fs::is_regular_file(row.scenePath())) << row.name << ": there is no scene " << row.scene;
    if (!fs::is_regular_file(row.scenePath())) continue;
    EXPECT_NO_THROW(row.frames()) << row.name;
    EXPECT_LE(row.times.back(), row.document().spec().time.duration) << row.name;
  }
}

TEST(GoldenTable, HasEverySceneThatShips) {
  // A scene under scenes/, or among those of the golden tests, without a row is an error.
  std::set<fs::path> named;
  for (const Row& row : rows()) named.insert(row.scenePath());
  for (const char* folder : {"scenes", "tests/golden/scenes"})
    for (const auto& entry : fs::recursive_directory_iterator(root() / folder))
      if (entry.path().extension() == ".yaml") {
        EXPECT_TRUE(named.contains(entry.path()))
            << "tests/golden/table.yaml has no row for " << fs::relative(entry.path(), root());
      }
}

TEST(GoldenTable, HasAnImageForEveryTime) {
  // A picture without a golden image is an error, never a reason to make one.
  for (const Row& row : rows())
    for (const double time : row.times)
      EXPECT_TRUE(fs::is_regular_file(row.image(time)))
          << row.image(time).string() << " is missing; make it with tests/golden/refresh " << row.name;
}

TEST(GoldenTable, NamesEveryImage) {
  // An image that no row speaks of is an error.
  std::set<fs::path> named;
  for (const Row& row : rows())
    for (const double time : row.times) named.insert(row.image(time));
  for (const auto& entry : fs::directory_iterator(images()))
    EXPECT_TRUE(named.contains(entry.path())) << "no row names " << entry.path().string();
}

TEST(GoldenTable, StaysSmall) {
  // All images together are under 2 MB: they live in the repository.
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::directory_iterator(images())) bytes += entry.file_size();
  EXPECT_LT(bytes, 2'000'000u);
}

TEST(GoldenTable, TellsTheLineOfAMistake) {
  // Unknown keys, rows of one name, times out of order and tolerances without a reason are refused.
  TemporaryFolder folder;
  for (const char* text :
       {"- {name: a, scene: s.yaml, at: [1]}\n- {name: b, scene: s.yaml, at: [1], colour: red}\n",
        "- {name: a, scene: s.yaml, at: [1]}\n- {name: a, scene: s.yaml, at: [1]}\n",
        "- {name: a, scene: s.yaml, at: [1]}\n- {name: b, scene: s.yaml, at: [2, 1]}\n",
        "- {name: a, scene: s.yaml, at: [1]}\n- {name: b, at: [1]}\n",
        "- {name: a, scene: s.yaml, at: [1]}\n- {name: b, scene: s.yaml, at: [1], tolerance: {level: 9}}\n",
        "- {name: a, scene: s.yaml, at: [1]}\n- {name: b, scene: s.yaml, at: [one]}\n"}) {
    writeText(folder / "table.yaml", text);
    try {
      readTable(folder / "table.yaml");
      ADD_FAILURE() << text;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("line 2"), std::string::npos) << error.what();
    }
  }
}

TEST(GoldenTable, IsAllThatTheReportSpeaksOf) {
  // Failures of rows that have been renamed or taken away do not stay in the report.
  std::set<std::string> wanted;
  for (const Row& row : rows())
    for (const double time : row.times)
      for (const GlBackend backend : builtGlBackends())
        for (const int threads : {1, 2})
          wanted.insert(row.pictureName(time) + "-" + Variant{backend, threads}.name());
  const Report report = buildReport();
  buildReport().keepOnly(wanted);
  if (!fs::exists(report.page())) return;
  for (const auto& entry : fs::directory_iterator(report.page().parent_path())) {
    if (entry.is_directory()) {
      EXPECT_TRUE(wanted.contains(entry.path().filename())) << entry.path();
    }
  }
}

}  // namespace
}  // namespace smokebox::golden
