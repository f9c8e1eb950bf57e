#include "base/errors.h"

#include <utility>

namespace smokebox {

std::string SourcePlace::text() const {
  std::string text = file;
  if (line > 0) text += ":" + std::to_string(line);
  if (line > 0 && column > 0) text += ":" + std::to_string(column);
  return text;
}

namespace {
/// Control characters as they are written in YAML, so that each problem is one line.
std::string onOneLine(const std::string& text) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string line;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '\n')
      line += "\\n";
    else if (c == '\t')
      line += "\\t";
    else if (code < 0x20 || code == 0x7f)
      line += std::string("\\x") + kDigits[code >> 4] + kDigits[code & 15];
    else
      line += c;
  }
  return line;
}
}  // namespace

std::string Problem::text() const {
  std::string text = place.text();
  if (!text.empty()) text += ": ";
  if (warning) text += "warning: ";
  text += message;
  if (!hint.empty()) text += " (" + hint + ")";
  return onOneLine(text);
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
