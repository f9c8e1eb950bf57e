// What a golden test that fails leaves behind.
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "golden/set/golden_report.h"
#include "image/png.h"
#include "support/temporary_folder.h"

namespace smokebox::golden {
namespace {

Image flat(std::uint8_t value, int width = 32, int height = 18) {
  Image image(width, height);
  for (std::size_t k = 0; k < image.rgba.size(); ++k) image.rgba[k] = k % 4 == 3 ? 255 : value;
  return image;
}

TEST(GoldenReport, ShowsEachFailureUntilItIsMended) {
  // A failure has a folder with its pictures and a place on the page; one that is mended has neither any
  // more.
  TemporaryFolder folder;
  Report report(folder / "report");
  report.add("wake-1.00-osmesa-2-threads", flat(10), flat(60), {}, "all of it <too> dark");
  report.add("new-0.50-egl-2-threads", flat(30), {}, {}, "there is no golden image");
  report.add("wide-0.50-egl-2-threads", flat(30), flat(30, 64, 18), {}, "another size");
  const auto wake = folder / "report" / "wake-1.00-osmesa-2-threads";
  EXPECT_EQ(readPng(wake / "picture.png").rgba, flat(10).rgba);
  EXPECT_EQ(readPng(wake / "golden.png").rgba, flat(60).rgba);
  EXPECT_EQ(readPng(wake / "difference.png").width, 32);
  EXPECT_FALSE(std::filesystem::exists(folder / "report" / "new-0.50-egl-2-threads" / "golden.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "report" / "wide-0.50-egl-2-threads" / "difference.png"));
  const std::string page = fileText(report.page());
  for (const char* text : {"all of it &lt;too> dark", "wake-1.00-osmesa-2-threads/picture.png",
                           "wake-1.00-osmesa-2-threads/golden.png", "there is no golden image",
                           "wake-1.00-osmesa-2-threads/difference.png", "pixelated", "3 pictures are"})
    EXPECT_NE(page.find(text), std::string::npos) << text << "\n" << page;

  report.remove("wake-1.00-osmesa-2-threads");
  EXPECT_FALSE(std::filesystem::exists(wake));
  EXPECT_EQ(fileText(report.page()).find("wake"), std::string::npos);
  EXPECT_NE(fileText(report.page()).find("new-0.50"), std::string::npos);
  report.keepOnly({});
  EXPECT_NE(fileText(report.page()).find("All pictures are"), std::string::npos);
}

TEST(GoldenReport, IsWholeWhenManyFailAtOnce) {
  // Failures that come at the same time are all on the page.
  TemporaryFolder folder;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int k = 0; k < 5; ++k)
        Report(folder / "report").add("row" + std::to_string(5 * t + k), flat(10), flat(60), {}, "dark");
    });
  for (std::thread& thread : threads) thread.join();
  const std::string page = fileText(folder / "report" / "index.html");
  EXPECT_NE(page.find("20 pictures are"), std::string::npos);
  for (int k = 0; k < 20; ++k)
    EXPECT_NE(page.find("<h2>row" + std::to_string(k) + "</h2>"), std::string::npos) << k;
}

}  // namespace
}  // namespace smokebox::golden
