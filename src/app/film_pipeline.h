// Simulation, drawing and encoding at the same time. The caller simulates and hands over snapshots; one
// thread draws them (it has the OpenGL context), one encodes. Snapshots and images go round between the
// stages, few of each: a stage that runs ahead waits, and after the first frames nothing is allocated.
#pragma once
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "app/channel.h"
#include "app/film_frames.h"
#include "image/image.h"
#include "video/sink.h"
#include "world/snapshot.h"

namespace smokebox {

/// Where frames go, and which.
struct FilmOutput {
  std::unique_ptr<FrameSink> sink;
  FrameRange frames;
};

class FilmPipeline {
 public:
  FilmPipeline(int width, int height, std::vector<FilmOutput> outputs);
  /// Breaks off unless finish() was called: what the outputs have not finished, they remove.
  ~FilmPipeline();
  FilmPipeline(const FilmPipeline&) = delete;
  FilmPipeline& operator=(const FilmPipeline&) = delete;

  /// Waits for a snapshot that can be filled. Throws what went wrong in another stage.
  std::unique_ptr<Snapshot> next();
  /// To be drawn; `snapshot->frame` says where it goes.
  void submit(std::unique_ptr<Snapshot> snapshot);
  /// Waits until all is drawn and written, and finishes the outputs. Throws what went wrong in any stage.
  void finish();

 private:
  struct Picture {
    Image image;
    long frame = 0;
  };

  void draw(int width, int height);
  void encode();
  /// Runs a stage; its first exception stops the others, and is kept for the caller.
  template <class Stage>
  void guarded(Stage&& stage);
  void breakOff();
  [[noreturn]] void rethrow();

  std::vector<FilmOutput> outputs_;
  Channel<std::unique_ptr<Snapshot>> freeSnapshots_, snapshots_;
  Channel<std::unique_ptr<Picture>> freePictures_, pictures_;
  std::mutex errorMutex_;
  std::exception_ptr error_;
  std::thread drawing_, encoding_;
};

}  // namespace smokebox
