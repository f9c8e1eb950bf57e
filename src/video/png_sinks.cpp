#include "video/png_sinks.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <system_error>
#include <utility>

#include "base/errors.h"
#include "base/part_file.h"

namespace smokebox {
namespace fs = std::filesystem;

namespace {

constexpr int kMaxDigits = 9;

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// End of the field "%d", "%5d", "%05d" that starts at `at`, or 0 if there is none.
std::size_t fieldEnd(const std::string& text, std::size_t at) {
  if (text[at] != '%') return 0;
  std::size_t k = at + 1;
  while (k < text.size() && isDigit(text[k])) ++k;
  return k < text.size() && text[k] == 'd' ? k + 1 : 0;
}

int countFields(const std::string& text) {
  int count = 0;
  for (std::size_t k = 0; k < text.size(); ++k) count += fieldEnd(text, k) != 0;
  return count;
}

}  // namespace

std::optional<FramePattern> FramePattern::parse(const std::string& output) {
  const fs::path path(output);
  const std::string name = path.filename().string(), folder = path.parent_path().string();
  const int fields = countFields(name);
  if (fields + countFields(folder) == 0) return std::nullopt;
  if (fields != 1 || countFields(folder) != 0)
    throw UsageError(output +
                     ": the name of a frame must have one field for its number, such as frames/%05d.png");
  FramePattern pattern;
  pattern.folder = path.parent_path();
  std::size_t start = 0;
  while (fieldEnd(name, start) == 0) ++start;
  const std::size_t end = fieldEnd(name, start);
  const std::string width = name.substr(start + 1, end - start - 2);
  pattern.zeros = !width.empty() && width[0] == '0';
  if (!width.empty()) std::from_chars(width.data(), width.data() + width.size(), pattern.digits);
  if (width.size() > 3 || pattern.digits > kMaxDigits)
    throw UsageError(output + ": a number of a frame has no more than " + std::to_string(kMaxDigits) +
                     " digits");
  pattern.before = name.substr(0, start);
  pattern.after = name.substr(end);
  return pattern;
}

fs::path FramePattern::file(long frame) const {
  std::string number = std::to_string(frame);
  if (static_cast<int>(number.size()) < digits) number.insert(0, digits - number.size(), zeros ? '0' : ' ');
  return folder / (before + number + after);
}

bool FramePattern::matches(const std::string& name) const {
  if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after))
    return false;
  const std::string number = name.substr(before.size(), name.size() - before.size() - after.size());
  const auto firstDigit = std::find_if(number.begin(), number.end(), isDigit);
  return std::all_of(number.begin(), firstDigit, [](char c) { return c == ' '; }) &&
         firstDigit != number.end() && std::all_of(firstDigit, number.end(), isDigit) &&
         static_cast<int>(number.size()) >= digits;
}

std::vector<long> FramePattern::numbers() const {
  std::vector<long> numbers;
  const fs::path from = folder.empty() ? fs::path(".") : folder;
  std::error_code error;
  for (fs::directory_iterator entry(from, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    long number = 0;
    if (matches(name) &&
        std::from_chars(name.data() + name.find_first_not_of(' ', before.size()), name.data() + name.size(),
                        number)
                .ec == std::errc() &&
        file(number).filename() == name)
      numbers.push_back(number);
  }
  if (error) throw IoError(from.string() + ": cannot read this folder: " + error.message());
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

PngSequenceSink::PngSequenceSink(FramePattern pattern, const FilmFormat& format)
    : pattern_(std::move(pattern)), metadata_(format.metadata) {
  if (!pattern_.folder.empty()) {
    std::error_code error;
    fs::create_directories(pattern_.folder, error);
    if (error) throw IoError(pattern_.folder.string() + ": cannot make this folder: " + error.message());
  }
  const PartFile probe(pattern_.file(0));  // finds out now whether the folder takes files
}

void PngSequenceSink::add(const Image& image, long frame) {
  writePng(pattern_.file(frame), image, metadata_);
}

PngStillSink::PngStillSink(fs::path file, const FilmFormat& format)
    : file_(std::move(file)), metadata_(format.metadata) {
  const PartFile probe(file_);
}

void PngStillSink::finish() {
  if (image_) writePng(file_, *image_, metadata_);
}

}  // namespace smokebox
