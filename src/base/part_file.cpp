#include "base/part_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
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

/// Between the opening and the locking of a file, who had it may have given it its final name.
bool isStillNamed(int file, const fs::path& name) {
  struct stat opened = {}, named = {};
  return ::fstat(file, &opened) == 0 && ::stat(name.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

/// Makes the file, or takes over what a killed run left, and locks it until it is closed.
int openAlone(const fs::path& part, const fs::path& target, const fs::path& folder) {
  for (;;) {
    const int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) throw IoError(target.string() + ": cannot write to " + folder.string() + ": " + reason());
    // Where a file system has no locks, nothing is known of others.
    if (::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(file);
      throw IoError(target.string() + ": is being written already, by another run or for another -o");
    }
    if (isStillNamed(file, part)) return file;
    ::close(file);
  }
}

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
  lock_ = openAlone(path_, target, folder);
}

PartFile::~PartFile() {
  std::error_code ignored;  // a destructor has nobody to tell
  if (!direct_ && !committed_) fs::remove(path_, ignored);
  if (lock_ >= 0) ::close(lock_);  // last: until then the name is ours
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
