#include "video/film_reader.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "image/png.h"
#include "video/libav.h"
#include "video/png_sinks.h"
#include "video/rgb.h"

namespace smokebox {
namespace fs = std::filesystem;

using libav::allocated;
using libav::checkRead;

struct FilmReader::Film {
  int width = 0, height = 0;
  double fps = 0;
  long count = 0;
  virtual ~Film() = default;
  virtual bool next(Image& image) = 0;
};

namespace {

struct CloseInput {
  void operator()(AVFormatContext* p) const { avformat_close_input(&p); }
};
using Input = std::unique_ptr<AVFormatContext, CloseInput>;

Input openInput(const std::string& file) {
  libav::Dictionary options;
  options.set("protocol_whitelist", "file");
  options.set("pattern_type", "none");  // the file of this very name, be there a % in it
  AVFormatContext* raw = nullptr;
  checkRead(avformat_open_input(&raw, ("file:" + file).c_str(), nullptr, options.handle()), file);
  return Input(raw);
}

std::string lowerEnding(const fs::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

}  // namespace

class FilmReader::FilmFile : public FilmReader::Film {
 public:
  explicit FilmFile(const std::string& file) : file_(file), input_(openInput(file)), converter_(file) {
    checkRead(avformat_find_stream_info(input_.get(), nullptr), file_);
    const AVCodec* codec = nullptr;
    const int index = av_find_best_stream(input_.get(), AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    if (index == AVERROR_STREAM_NOT_FOUND) throw IoError(file_ + ": there are no pictures in it");
    stream_ = input_->streams[checkRead(index, file_)];
    for (unsigned k = 0; k < input_->nb_streams; ++k)
      if (input_->streams[k] != stream_) input_->streams[k]->discard = AVDISCARD_ALL;
    decoder_.reset(allocated(avcodec_alloc_context3(codec)));
    checkRead(avcodec_parameters_to_context(decoder_.get(), stream_->codecpar), file_);
    decoder_->flags |= AV_CODEC_FLAG_BITEXACT;
    decoder_->err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER | AV_EF_EXPLODE;
    decoder_->thread_count = 0;  // as many as there are cores
    checkRead(avcodec_open2(decoder_.get(), codec, nullptr), file_);
    width = stream_->codecpar->width;
    height = stream_->codecpar->height;
    const AVRational rate = stream_->avg_frame_rate;
    if (rate.num > 0 && rate.den > 0) fps = av_q2d(rate);
  }

  bool next(Image& image) override {
    for (;;) {
      const int code = avcodec_receive_frame(decoder_.get(), frame_.get());
      if (code == AVERROR_EOF) return false;
      if (code == AVERROR(EAGAIN)) {
        checkInvariant(!drained_, "a decoder that was given everything gives everything");
        feed();
        continue;
      }
      checkDamage(frame_->decode_error_flags ? AVERROR_INVALIDDATA : code);
      if (frame_->width != width || frame_->height != height)
        throw IoError(file_ + ": changes its size at frame " + std::to_string(count));
      converter_.convert(*frame_, image);
      av_frame_unref(frame_.get());
      ++count;
      return true;
    }
  }

 private:
  /// Hands the decoder one packet more, or the end.
  void feed() {
    for (;;) {
      const int code = av_read_frame(input_.get(), packet_.get());
      if (code == AVERROR_EOF) {
        if (input_->pb && input_->pb->error != AVERROR_EOF) checkDamage(input_->pb->error);
        checkDamage(avcodec_send_packet(decoder_.get(), nullptr));
        drained_ = true;
        return;
      }
      checkDamage(code);
      const bool ours = packet_->stream_index == stream_->index;
      const bool corrupt = packet_->flags & AV_PKT_FLAG_CORRUPT;
      const int sent = ours ? avcodec_send_packet(decoder_.get(), packet_.get()) : 0;
      av_packet_unref(packet_.get());
      if (!ours) continue;
      checkDamage(corrupt ? AVERROR_INVALIDDATA : sent);
      return;
    }
  }

  void checkDamage(int code) const {
    if (code == AVERROR(ENOMEM)) throw std::bad_alloc();
    if (code < 0)
      throw IoError(file_ + ": is damaged at about frame " + std::to_string(count) + ": " +
                    libav::errorText(code));
  }

  std::string file_;
  Input input_;
  AVStream* stream_ = nullptr;  // of the input
  libav::Codec decoder_;
  libav::Packet packet_{allocated(av_packet_alloc())};
  libav::Frame frame_{allocated(av_frame_alloc())};
  RgbConverter converter_;
  bool drained_ = false;
};

/// A folder of numbered pictures, each a file of its own.
class FilmReader::FilmFolder : public FilmReader::Film {
 public:
  FilmFolder(const std::string& name, FramePattern pattern) : name_(name), pattern_(std::move(pattern)) {
    const std::vector<long> numbers = pattern_.numbers();
    if (numbers.empty()) throw IoError(name + ": there is no picture of this name");
    first_ = numbers.front();
    end_ = numbers.back() + 1;
    for (std::size_t k = 0; k < numbers.size(); ++k)
      if (const long number = first_ + static_cast<long>(k); numbers[k] != number)
        throw IoError(pattern_.file(number).string() + ": is not there, but later frames are");
    const Image image = read(first_);
    width = image.width;
    height = image.height;
  }

  bool next(Image& image) override {
    if (first_ + count == end_) return false;
    image = read(first_ + count);
    if (image.width != width || image.height != height)
      throw IoError(name_ + ": changes its size at frame " + std::to_string(count));
    ++count;
    return true;
  }

 private:
  Image read(long number) const {
    const fs::path file = pattern_.file(number);
    if (lowerEnding(file) == ".png") return readPng(file);
    Image image;
    if (!FilmFile(file.string()).next(image)) throw IoError(file.string() + ": there is no picture in it");
    return image;
  }

  std::string name_;
  FramePattern pattern_;
  long first_ = 0, end_ = 0;
};

FilmReader::FilmReader(const std::string& file) {
  av_log_set_level(AV_LOG_QUIET);  // what goes wrong comes back as a code, and is said once, by us
  std::error_code error;
  const bool there = fs::exists(file, error);  // whatever signs are in its name
  if (auto pattern = there ? std::nullopt : FramePattern::parse(file))
    film_ = std::make_unique<FilmFolder>(file, *std::move(pattern));
  else
    film_ = std::make_unique<FilmFile>(file);
}

FilmReader::~FilmReader() = default;

int FilmReader::width() const { return film_->width; }
int FilmReader::height() const { return film_->height; }
double FilmReader::fps() const { return film_->fps; }
bool FilmReader::next(Image& image) { return film_->next(image); }
long FilmReader::count() const { return film_->count; }

}  // namespace smokebox
