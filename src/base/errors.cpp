#include "base/errors.h"

#include <utility>

namespace smokebox {

std::string SourcePlace::text() const {
  std::string text = file;
  if (line > 0) text += ":" + std::to_string(line);
  if (line > 0 && column > 0) text += ":" + std::to_string(column);
  return text;
}

std::string Problem::text() const {
  std::string text = place.text();
  if (!text.empty()) text += ": ";
  if (warning) text += "warning: ";
  text += message;
  if (!hint.empty()) text += " (" + hint + ")";
  return text;
}

namespace {
std::string joined(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += "\n";
    text += problem.text();
  }
  return text;
}
}  // namespace

SceneError::SceneError(std::vector<Problem> problems)
    : Error(ExitStatus::badScene, joined(problems)), problems_(std::move(problems)) {}

void checkInvariant(bool holds, const char* invariant) {
  if (!holds) throw std::logic_error(std::string("internal error, invariant broken: ") + invariant);
}

}  // namespace smokebox
