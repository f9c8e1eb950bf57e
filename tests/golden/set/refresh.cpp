// Renews golden images: smokebox_refresh_goldens [NAME...], all rows of the table or those that are named.
// Says for each image whether it is the same, changed (and how far), new, or removed. What differs within the
// tolerance is renewed only if its row is named: else every little change of rounding would touch half of the
// images. Started through tests/golden/refresh.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>

#include "golden/set/golden_run.h"
#include "image/png.h"

namespace smokebox::golden {
namespace {

namespace fs = std::filesystem;

std::string renewed(const fs::path& file, const Image& picture, const DifferenceTolerance& tolerance,
                    bool named) {
  std::string words = "new";
  if (fs::exists(file)) {
    const Image before = readPng(file);
    if (before.width != picture.width || before.height != picture.height) {
      words = "changed: another size";
    } else {
      const ImageDifference difference = measureDifference(before, picture, tolerance);
      if (difference.equal()) return "same";
      const bool within = difference.within(tolerance);
      words = std::string("changed") + (within ? " within the tolerance" : "") +
              (within && !named ? ", kept: " : ": ") + difference.inWords(tolerance);
      if (within && !named) return words;
    }
  }
  writePng(file, picture, {});
  return words;
}

void renew(const Row& row, bool named) {
  const std::vector<Image> pictures = draw(row, {});
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    const fs::path file = row.image(row.times[k]);
    std::printf("%s: %s\n", file.filename().c_str(),
                renewed(file, pictures[k], row.tolerance, named).c_str());
    std::fflush(stdout);
  }
}

/// Images that no row names.
void removeOrphans(const std::vector<Row>& rows) {
  std::set<fs::path> named, orphans;
  for (const Row& row : rows)
    for (const double time : row.times) named.insert(row.image(time));
  for (const auto& entry : fs::directory_iterator(images()))
    if (!named.contains(entry.path())) orphans.insert(entry.path());
  for (const fs::path& orphan : orphans) {
    fs::remove(orphan);
    std::printf("%s: removed\n", orphan.filename().c_str());
  }
}

void refresh(const std::set<std::string>& names) {
  const std::vector<Row> rows = readTable(root() / "tests/golden/table.yaml");
  for (const std::string& name : names)
    if (std::none_of(rows.begin(), rows.end(), [&](const Row& row) { return row.name == name; }))
      throw std::runtime_error("the table has no row " + name);
  fs::create_directories(images());
  for (const Row& row : rows)
    if (names.empty() || names.contains(row.name)) renew(row, !names.empty());
  if (names.empty()) removeOrphans(rows);
}

}  // namespace
}  // namespace smokebox::golden

int main(int argc, char** argv) {
  try {
    smokebox::golden::refresh({argv + 1, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
