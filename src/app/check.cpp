// `smokebox check SCENE...`: every problem of every scene, one a line, on standard output.
#include <algorithm>
#include <cstdio>

#include "app/commands.h"
#include "base/errors.h"
#include "scene/document.h"

namespace smokebox {

namespace {

std::vector<Problem> problemsOf(const std::string& file) {
  try {
    return SceneDocument::load(file).problems();
  } catch (const SceneError& error) {
    return error.problems();
  }
}

}  // namespace

int runCheck(const CheckOptions& options) {
  ExitStatus status = ExitStatus::ok;
  for (const std::string& file : options.scenes) {
    try {
      bool wrong = false;
      for (const Problem& problem : problemsOf(file)) {
        std::puts(problem.text().c_str());
        wrong |= !problem.warning;
      }
      if (wrong)
        status = std::max(status, ExitStatus::badScene);
      else
        std::printf("%s: ok\n", file.c_str());
    } catch (const IoError& error) {
      std::puts(error.what());
      status = std::max(status, ExitStatus::inputOutput);
    }
  }
  return static_cast<int>(status);
}

}  // namespace smokebox
