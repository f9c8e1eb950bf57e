#include "app/film_pipeline.h"

#include <utility>

#include "app/interrupt.h"
#include "base/errors.h"
#include "render/renderer.h"

namespace smokebox {

namespace {

// Enough that a frame that takes longer than others does not stop its neighbours.
constexpr int kSnapshots = 3, kPictures = 3;

}  // namespace

FilmPipeline::FilmPipeline(int width, int height, std::vector<FilmOutput> outputs)
    : outputs_(std::move(outputs)) {
  for (int k = 0; k < kSnapshots; ++k) freeSnapshots_.send(std::make_unique<Snapshot>());
  for (int k = 0; k < kPictures; ++k) freePictures_.send(std::make_unique<Picture>());
  drawing_ = std::thread([this, width, height] { guarded([&] { draw(width, height); }); });
  encoding_ = std::thread([this] { guarded([&] { encode(); }); });
}

FilmPipeline::~FilmPipeline() {
  breakOff();
  if (drawing_.joinable()) drawing_.join();
  if (encoding_.joinable()) encoding_.join();
}

std::unique_ptr<Snapshot> FilmPipeline::next() {
  std::optional<std::unique_ptr<Snapshot>> snapshot = freeSnapshots_.receive();
  if (!snapshot) rethrow();
  return std::move(*snapshot);
}

void FilmPipeline::submit(std::unique_ptr<Snapshot> snapshot) { snapshots_.send(std::move(snapshot)); }

void FilmPipeline::finish() {
  snapshots_.close();
  drawing_.join();
  encoding_.join();
  if (error_) std::rethrow_exception(error_);
}

void FilmPipeline::draw(int width, int height) {
  Renderer renderer(width, height);
  while (auto snapshot = snapshots_.receive()) {
    auto picture = freePictures_.receive();
    if (!picture) return;
    renderer.draw(**snapshot, (*picture)->image);
    (*picture)->frame = (*snapshot)->frame;
    pictures_.send(std::move(*picture));
    freeSnapshots_.send(std::move(*snapshot));
  }
  pictures_.close();
}

void FilmPipeline::encode() {
  for (;;) {
    auto picture = pictures_.receive();
    if (!picture) break;
    for (FilmOutput& output : outputs_)
      if (output.frames.has((*picture)->frame)) output.sink->add((*picture)->image, (*picture)->frame);
    freePictures_.send(std::move(*picture));
  }
  if (pictures_.broken()) return;
  for (FilmOutput& output : outputs_) {
    throwIfInterrupted();
    output.sink->finish();
  }
}

template <class Stage>
void FilmPipeline::guarded(Stage&& stage) {
  try {
    stage();
  } catch (...) {
    {
      const std::lock_guard lock(errorMutex_);
      if (!error_) error_ = std::current_exception();
    }
    breakOff();
  }
}

void FilmPipeline::breakOff() {
  freeSnapshots_.breakOff();
  snapshots_.breakOff();
  freePictures_.breakOff();
  pictures_.breakOff();
}

void FilmPipeline::rethrow() {
  const std::lock_guard lock(errorMutex_);
  checkInvariant(error_ != nullptr, "the film's stages stop only for a reason");
  std::rethrow_exception(error_);
}

}  // namespace smokebox
