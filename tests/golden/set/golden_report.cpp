#include "golden/set/golden_report.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <sstream>
#include <stdexcept>

#include "base/part_file.h"
#include "image/png.h"
#include "support/temporary_folder.h"

namespace smokebox::golden {

namespace {

namespace fs = std::filesystem;

/// One process at a time, and one thread.
class FolderLock {
 public:
  explicit FolderLock(const fs::path& folder) {
    fs::create_directories(folder);
    file_ = open((folder / ".lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    if (file_ < 0 || flock(file_, LOCK_EX) != 0) throw std::runtime_error("cannot lock " + folder.string());
  }
  ~FolderLock() { close(file_); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_ = -1;
};

std::string escaped(const std::string& words) {
  std::string out;
  for (const char c : words) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

constexpr const char* kHead = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Golden images</title>
<style>
  body { font: 15px/1.4 sans-serif; margin: 2em; background: #e9e9e6; color: #222; }
  section { margin: 0 0 2em; padding: 1em; background: #fff; border-radius: 6px; }
  .pictures { display: flex; gap: 12px; overflow-x: auto; }
  figure { margin: 0; } figcaption { color: #666; }
  img { image-rendering: pixelated; display: block; }
  code { background: #eee; padding: 0 .3em; }
</style></head><body>
)";

}  // namespace

void Report::add(const std::string& entry, const Image& picture, const std::optional<Image>& golden,
                 const DifferenceTolerance& tolerance, const std::string& words) {
  const FolderLock lock(folder_);
  const fs::path place = folder_ / entry;
  fs::remove_all(place);
  fs::create_directories(place);
  writePng(place / "picture.png", picture, {});
  if (golden) {
    writePng(place / "golden.png", *golden, {});
    if (golden->width == picture.width && golden->height == picture.height)
      writePng(place / "difference.png", differencePicture(*golden, picture, tolerance), {});
  }
  writeWholeFile(place / "words.txt", words + "\n");
  writePage();
}

void Report::remove(const std::string& entry) {
  // In most runs there is none: then nothing is locked or written.
  if (!fs::exists(folder_ / entry)) return;
  const FolderLock lock(folder_);
  fs::remove_all(folder_ / entry);
  writePage();
}

void Report::keepOnly(const std::set<std::string>& wanted) {
  if (!fs::exists(folder_)) return;
  const FolderLock lock(folder_);
  for (const std::string& entry : entries())
    if (!wanted.contains(entry)) fs::remove_all(folder_ / entry);
  writePage();
}

std::set<std::string> Report::entries() const {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_))
    if (entry.is_directory()) names.insert(entry.path().filename());
  return names;
}

void Report::writePage() const {
  const std::set<std::string> names = entries();
  std::ostringstream html;
  html << kHead << "<h1>Golden images</h1>\n";
  if (names.empty())
    html << "<p>All pictures are as their golden images.</p>\n";
  else
    html << "<p>" << names.size() << " picture" << (names.size() == 1 ? " is" : "s are")
         << " not as the golden image. If that is meant to be, renew it: <code>tests/golden/refresh "
            "NAME</code>.</p>\n";
  for (const std::string& name : names) {
    html << "<section><h2>" << escaped(name) << "</h2>\n<p>"
         << escaped(fileText(folder_ / name / "words.txt")) << "</p>\n<div class=\"pictures\">\n";
    for (const char* kind : {"picture", "golden", "difference"}) {
      const fs::path file = folder_ / name / (std::string(kind) + ".png");
      if (!fs::exists(file)) continue;
      html << "<figure><img src=\"" << name << "/" << kind << ".png\" width=\"" << 2 * readPng(file).width
           << "\" alt=\"" << kind << "\"><figcaption>" << kind << "</figcaption></figure>\n";
    }
    html << "</div></section>\n";
  }
  html << "</body></html>\n";
  writeWholeFile(page(), html.str());
}

Report buildReport() { return Report(fs::path(SMOKEBOX_BINARY_DIR) / "golden-report"); }

}  // namespace smokebox::golden
