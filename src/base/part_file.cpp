#include "base/part_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>

#include "base/errors.h"

namespace smokebox {
namespace fs = std::filesystem;

namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string reason() { return std::strerror(errno); }

}  // namespace

PartFile::PartFile(const fs::path& target) : target_(target) {
  std::error_code error;
  if (fs::is_symlink(target_, error)) {
    const fs::path resolved = fs::weakly_canonical(target_, error);
    if (!error) target_ = resolved;
  }
  const fs::file_status status = fs::status(target_, error);
  if (fs::is_directory(status)) throw IoError(target.string() + ": is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    direct_ = true;
    path_ = target_;
    return;
  }
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error))
    throw IoError(target.string() + ": there is no folder " + folder.string());
  path_ = target_;
  path_ += ".part";
  // Made at once: a folder that takes no files is found before any work is done.
  const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) throw IoError(target.string() + ": cannot write to " + folder.string() + ": " + reason());
  ::close(file);
}

PartFile::~PartFile() {
  if (direct_ || committed_) return;
  std::error_code ignored;  // a destructor has nobody to tell
  fs::remove(path_, ignored);
}

void PartFile::commit() {
  if (!direct_) {
    std::error_code error;
    fs::rename(path_, target_, error);
    if (error) throw IoError(target_.string() + ": cannot rename " + path_.string() + ": " + error.message());
  }
  committed_ = true;
}

void writeWholeFile(const fs::path& target, std::string_view content) {
  PartFile part(target);
  std::unique_ptr<std::FILE, CloseFile> file(std::fopen(part.path().c_str(), "wb"));
  if (!file) throw IoError(target.string() + ": " + reason());
  // What does not fit shows only when the buffer is flushed.
  if (std::fwrite(content.data(), 1, content.size(), file.get()) != content.size() ||
      std::fflush(file.get()) != 0)
    throw IoError(target.string() + ": " + reason());
  if (std::fclose(file.release()) != 0) throw IoError(target.string() + ": " + reason());
  part.commit();
}

}  // namespace smokebox
