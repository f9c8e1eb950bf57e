// What failed, to be looked at: a folder for each picture that is not as its golden image, with picture,
// golden image and difference, and one page that shows all of them. Tests run as many processes at once: the
// page is made anew from the folders, under a lock, whenever one of them comes or goes.
#pragma once
#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "image/difference.h"
#include "image/image.h"

namespace smokebox::golden {

class Report {
 public:
  /// `folder`: made when it is needed.
  explicit Report(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// `entry` such as "wake-1.50-egl-2-threads"; no `golden`: there is none. `words`: what is wrong.
  void add(const std::string& entry, const Image& picture, const std::optional<Image>& golden,
           const DifferenceTolerance& tolerance, const std::string& words);
  /// That picture is as it should be.
  void remove(const std::string& entry);
  /// Removes the entries that nothing speaks of any more.
  void keepOnly(const std::set<std::string>& entries);

  std::filesystem::path page() const { return folder_ / "index.html"; }

 private:
  std::set<std::string> entries() const;
  void writePage() const;

  std::filesystem::path folder_;
};

/// build/golden-report.
Report buildReport();

}  // namespace smokebox::golden
