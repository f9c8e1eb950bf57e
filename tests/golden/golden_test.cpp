// Every picture of the table, drawn by the program on each way to OpenGL, against its golden image.
#include <gtest/gtest.h>

#include <cstdio>
#include <tuple>

#include "golden/set/golden_report.h"
#include "golden/set/golden_run.h"
#include "image/png.h"
#include "support/print_backend.h"

namespace smokebox::golden {

namespace {

class Golden : public testing::TestWithParam<std::tuple<Row, GlBackend>> {
 protected:
  const Row& row() const { return std::get<0>(GetParam()); }
  GlBackend backend() const { return std::get<1>(GetParam()); }

  /// Compares the pictures with the golden images; what is not as it was goes into the report.
  void check(const Variant& variant, const std::vector<Image>& pictures) {
    std::size_t equal = 0;
    for (std::size_t k = 0; k < pictures.size(); ++k) {
      const double time = row().times[k];
      const std::string entry = row().pictureName(time) + "-" + variant.name();
      const std::filesystem::path file = row().image(time);
      std::optional<Image> golden;
      std::string words;
      if (!std::filesystem::exists(file)) {
        words = "there is no golden image " + file.string();
      } else {
        golden = readPng(file);
        if (golden->width != pictures[k].width || golden->height != pictures[k].height) {
          words = "the golden image has another size";
        } else {
          const ImageDifference difference = measureDifference(*golden, pictures[k], row().tolerance);
          equal += difference.equal();
          if (!difference.within(row().tolerance)) words = difference.inWords(row().tolerance);
        }
      }
      if (words.empty()) {
        report_.remove(entry);
        continue;
      }
      report_.add(entry, pictures[k], golden, row().tolerance, words);
      ADD_FAILURE() << entry << ": " << words << "\nSee " << report_.page().string();
    }
    std::printf("%s, %s: %zu of %zu pictures equal to the golden images to the byte\n", row().name.c_str(),
                variant.name().c_str(), equal, pictures.size());
  }

 private:
  Report report_ = buildReport();
};

TEST_P(Golden, PictureIsAsItWas) {
  // Truth: each picture is its golden image within the tolerance; and the number of threads does not change a
  // byte.
  const Variant two{backend(), 2}, one{backend(), 1};
  const std::vector<Image> pictures = draw(row(), two);
  check(two, pictures);
  if (backend() != defaultGlBackend()) return;  // threads belong to the simulation: one backend tells
  const std::vector<Image> alone = draw(row(), one);
  check(one, alone);
  for (std::size_t k = 0; k < pictures.size(); ++k)
    EXPECT_TRUE(pictures[k].rgba == alone[k].rgba) << row().pictureName(row().times[k]) << " with one thread";
}

INSTANTIATE_TEST_SUITE_P(Set, Golden,
                         testing::Combine(testing::ValuesIn(rows()), testing::ValuesIn(builtGlBackends())),
                         [](const auto& instance) {
                           return testName(std::get<0>(instance.param).name + "_" +
                                           nameOf(std::get<1>(instance.param)));
                         });

}  // namespace
}  // namespace smokebox::golden
