// Simulation, drawing and encoding at the same time. The caller simulates and hands over what a frame shows,
// one snapshot for each of its panels; one thread draws (it has the OpenGL context), one encodes. Frames and
// images go round between the stages, few of each: a stage that runs ahead waits, and after the first frames
// nothing is allocated.
#pragma once
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "app/channel.h"
#include "app/film_frames.h"
#include "image/image.h"
#include "render/gl_backend.h"
#include "video/sink.h"
#include "world/snapshot.h"

namespace smokebox {

/// Where frames go, and which.
struct FilmOutput {
  std::unique_ptr<FrameSink> sink;
  FrameRange frames;
};

/// What one frame of a film is drawn from.
struct FilmFrame {
  long number = 0;
  std::vector<Snapshot> panels;
};

/// Draws a frame. Made and used by the drawing thread alone.
using PaintFrame = std::function<void(const FilmFrame& frame, Image& image)>;
/// The first panel is the whole picture.
std::function<PaintFrame()> paintOnePanel(int width, int height, GlBackend backend);

class FilmPipeline {
 public:
  FilmPipeline(int panels, std::vector<FilmOutput> outputs, std::function<PaintFrame()> makePainter);
  /// Breaks off unless finish() was called: what the outputs have not finished, they remove.
  ~FilmPipeline();
  FilmPipeline(const FilmPipeline&) = delete;
  FilmPipeline& operator=(const FilmPipeline&) = delete;

  /// Waits for a frame that can be filled. Throws what went wrong in another stage.
  std::unique_ptr<FilmFrame> next();
  /// To be drawn, in the order of the film; from any thread.
  void submit(std::unique_ptr<FilmFrame> frame);
  /// Breaks off because of what went wrong outside; from any thread. The first reason is kept.
  void fail(std::exception_ptr reason);
  /// Waits until all is drawn and written, and finishes the outputs. Throws what went wrong in any stage.
  void finish();

 private:
  struct Picture {
    Image image;
    long frame = 0;
  };

  void draw(const std::function<PaintFrame()>& makePainter);
  void encode();
  /// Runs a stage; its first exception stops the others, and is kept for the caller.
  template <class Stage>
  void guarded(Stage&& stage);
  void breakOff();
  [[noreturn]] void rethrow();

  std::vector<FilmOutput> outputs_;
  Channel<std::unique_ptr<FilmFrame>> freeFrames_, frames_;
  Channel<std::unique_ptr<Picture>> freePictures_, pictures_;
  std::mutex errorMutex_;
  std::exception_ptr error_;
  std::thread drawing_, encoding_;
};

}  // namespace smokebox
