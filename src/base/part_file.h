// A file that is written beside its final name and renamed when it is whole, so that nothing half-written
// ever stands under the final name.
#pragma once
#include <filesystem>
#include <string_view>

namespace smokebox {

class PartFile {
 public:
  /// Chooses where to write: `<target>.part` in the same folder. A symbolic link is followed. What exists and
  /// is no regular file (a device, a pipe) is written directly, for a rename would replace it. Throws IoError
  /// if the target is a folder, its folder is not there or takes no files, or the target is being written
  /// already, by another run or under another spelling of its name; what a killed run left is taken over.
  explicit PartFile(const std::filesystem::path& target);
  /// Removes what was written, unless it was committed.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// The file to write to.
  const std::filesystem::path& path() const { return path_; }
  /// The target is a device or a pipe.
  bool direct() const { return direct_; }
  /// To be called when the file is closed. Throws IoError.
  void commit();

 private:
  std::filesystem::path target_, path_;
  bool direct_ = false, committed_ = false;
  int lock_ = -1;  // held as long as the file is ours: two that wrote to one would spoil it
};

/// Writes a whole small file so. Throws IoError, also for a full disk.
void writeWholeFile(const std::filesystem::path& target, std::string_view content);

}  // namespace smokebox
