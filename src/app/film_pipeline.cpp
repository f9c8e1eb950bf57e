#include "app/film_pipeline.h"

#include <utility>

#include "app/interrupt.h"
#include "base/errors.h"
#include "render/renderer.h"

namespace smokebox {

namespace {

// Enough that a frame that takes longer than others does not stop its neighbours.
constexpr int kFrames = 3, kPictures = 3;

}  // namespace

std::function<PaintFrame()> paintOnePanel(int width, int height, GlBackend backend) {
  return [=]() -> PaintFrame {
    const auto renderer = std::make_shared<Renderer>(width, height, backend);
    return [renderer](const FilmFrame& frame, Image& image) { renderer->draw(frame.panels[0], image); };
  };
}

FilmPipeline::FilmPipeline(int panels, std::vector<FilmOutput> outputs,
                           std::function<PaintFrame()> makePainter)
    : outputs_(std::move(outputs)) {
  for (int k = 0; k < kFrames; ++k) {
    auto frame = std::make_unique<FilmFrame>();
    frame->panels.resize(panels);
    freeFrames_.send(std::move(frame));
  }
  for (int k = 0; k < kPictures; ++k) freePictures_.send(std::make_unique<Picture>());
  drawing_ = std::thread([this, make = std::move(makePainter)] { guarded([&] { draw(make); }); });
  encoding_ = std::thread([this] { guarded([&] { encode(); }); });
}

FilmPipeline::~FilmPipeline() {
  breakOff();
  if (drawing_.joinable()) drawing_.join();
  if (encoding_.joinable()) encoding_.join();
}

std::unique_ptr<FilmFrame> FilmPipeline::next() {
  std::optional<std::unique_ptr<FilmFrame>> frame = freeFrames_.receive();
  if (!frame) rethrow();
  return std::move(*frame);
}

void FilmPipeline::submit(std::unique_ptr<FilmFrame> frame) { frames_.send(std::move(frame)); }

void FilmPipeline::finish() {
  frames_.close();
  drawing_.join();
  encoding_.join();
  if (error_) std::rethrow_exception(error_);
}

void FilmPipeline::draw(const std::function<PaintFrame()>& makePainter) {
  const PaintFrame paint = makePainter();
  while (auto frame = frames_.receive()) {
    auto picture = freePictures_.receive();
    if (!picture) return;
    paint(**frame, (*picture)->image);
    (*picture)->frame = (*frame)->number;
    pictures_.send(std::move(*picture));
    freeFrames_.send(std::move(*frame));
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
    fail(std::current_exception());
  }
}

void FilmPipeline::fail(std::exception_ptr reason) {
  {
    const std::lock_guard lock(errorMutex_);
    if (!error_) error_ = std::move(reason);
  }
  breakOff();
}

void FilmPipeline::breakOff() {
  freeFrames_.breakOff();
  frames_.breakOff();
  freePictures_.breakOff();
  pictures_.breakOff();
}

void FilmPipeline::rethrow() {
  const std::lock_guard lock(errorMutex_);
  checkInvariant(error_ != nullptr, "the film's stages stop only for a reason");
  std::rethrow_exception(error_);
}

}  // namespace smokebox
