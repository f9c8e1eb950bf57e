// The FFmpeg libraries: handles that free themselves, and return codes that become exceptions.
#pragma once
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/dict.h>
#include <libavutil/frame.h>
}

#include <memory>
#include <string>

namespace smokebox::libav {

struct Deleter {
  void operator()(AVFormatContext* p) const { avformat_free_context(p); }
  void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
  void operator()(AVFrame* p) const { av_frame_free(&p); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
  void operator()(AVIOContext* p) const { avio_close(p); }
  void operator()(AVDictionary* p) const { av_dict_free(&p); }
};
using Format = std::unique_ptr<AVFormatContext, Deleter>;
using Codec = std::unique_ptr<AVCodecContext, Deleter>;
using Frame = std::unique_ptr<AVFrame, Deleter>;
using Packet = std::unique_ptr<AVPacket, Deleter>;
using Io = std::unique_ptr<AVIOContext, Deleter>;

/// Text of an AVERROR code.
std::string errorText(int code);
/// Throws VideoError "<what>: <reason>" if `code` is negative.
int check(int code, const std::string& what);
/// The same for what goes to a file: a code that comes from the system (a full disk) becomes an IoError.
int checkWrite(int code, const std::string& what);
/// Whatever is wrong with a film that is read is an IoError "<file>: cannot be read: <reason>".
int checkRead(int code, const std::string& file);
/// Throws std::bad_alloc if an allocation of libav gave nothing.
template <class T>
T* allocated(T* p) {
  if (!p) throw std::bad_alloc();
  return p;
}
/// Options by name.
class Dictionary {
 public:
  Dictionary() = default;
  ~Dictionary() { av_dict_free(&entries_); }
  Dictionary(const Dictionary&) = delete;
  Dictionary& operator=(const Dictionary&) = delete;
  void set(const std::string& key, const std::string& value) {
    check(av_dict_set(&entries_, key.c_str(), value.c_str(), 0), key);
  }
  AVDictionary** handle() { return &entries_; }

 private:
  AVDictionary* entries_ = nullptr;
};
/// A frame with its own buffer.
Frame makeFrame(int width, int height, AVPixelFormat format);

}  // namespace smokebox::libav
