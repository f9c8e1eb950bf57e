// PNG files as the output of a film: a folder of numbered frames, or a single still.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "video/sink.h"

namespace smokebox {

/// A file name with one field for the number of the frame: "frame_%05d.png".
struct FramePattern {
  std::filesystem::path folder;
  std::string before, after;  // of the field, in the name of the file
  int digits = 0;             // at least so many, filled up with zeros or spaces
  bool zeros = false;

  /// Nothing if there is no field in the file's name. Throws UsageError if there is more than one, or one in
  /// a folder.
  static std::optional<FramePattern> parse(const std::string& output);
  std::filesystem::path file(long frame) const;
  /// `name` is the file of some frame.
  bool matches(const std::string& name) const;
  /// Of the frames that are there, sorted. Throws IoError if the folder cannot be read.
  std::vector<long> numbers() const;
};

/// Each frame is a whole file as soon as it is there, and stays if the film is broken off.
class PngSequenceSink : public FrameSink {
 public:
  PngSequenceSink(FramePattern pattern, const FilmFormat& format);
  void add(const Image& image, long frame) override;
  void finish() override {}

 private:
  FramePattern pattern_;
  Metadata metadata_;
};

/// The last image that it was given.
class PngStillSink : public FrameSink {
 public:
  PngStillSink(std::filesystem::path file, const FilmFormat& format);
  void add(const Image& image, long) override { image_ = image; }
  void finish() override;

 private:
  std::filesystem::path file_;
  Metadata metadata_;
  std::optional<Image> image_;
};

}  // namespace smokebox
