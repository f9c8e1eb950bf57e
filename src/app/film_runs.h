// Several simulations in step, each on a thread of its own: the panels of one film.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/channel.h"
#include "app/film_pipeline.h"
#include "scene/document.h"
#include "world/ranges.h"

namespace smokebox {

/// Finds the ranges of all scenes at once, and makes them one: equal values have equal colours in all panels.
/// `eachFrame`: how far the first scene is, from a thread of its own.
FilmRanges commonRanges(const std::vector<SceneDocument>& scenes, int threadsEach,
                        const std::function<void(long done, long frames)>& eachFrame);

class FilmRuns {
 public:
  /// `labels`: name a run where it goes wrong. What goes wrong in a run breaks the pipeline off.
  FilmRuns(const std::vector<SceneDocument>& scenes, const std::vector<std::string>& labels, int threadsEach,
           const FilmRanges& ranges, FilmPipeline& pipeline);
  /// Stops what is still running.
  ~FilmRuns();
  FilmRuns(const FilmRuns&) = delete;
  FilmRuns& operator=(const FilmRuns&) = delete;

  /// Every run goes on to this frame and puts a snapshot of it into its panel; the last to do so hands the
  /// frame to the pipeline. In the order of the film.
  void advance(std::unique_ptr<FilmFrame> frame);
  /// Waits until all frames have been handed over.
  void finish();

 private:
  /// A frame on its way through the runs.
  struct Order {
    std::unique_ptr<FilmFrame> frame;
    std::atomic<int> missing;
  };
  void run(const SceneDocument& scene, const std::string& label, int panel);

  FilmPipeline& pipeline_;
  FilmRanges ranges_;
  int threadsEach_;
  std::atomic<bool> stop_{false};
  std::vector<Channel<std::shared_ptr<Order>>> orders_;  // one a run
  std::vector<std::thread> threads_;
};

}  // namespace smokebox
