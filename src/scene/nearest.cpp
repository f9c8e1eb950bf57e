#include "scene/nearest.h"

#include <algorithm>
#include <cctype>

namespace smokebox {

int editDistance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<int> before(width), last(width), now(width);
  for (std::size_t j = 0; j < width; ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = static_cast<int>(i);
    for (std::size_t j = 1; j < width; ++j) {
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(now);
  }
  return last[b.size()];
}

namespace {
/// Case and the choice of `_`, `-` or a space are the commonest slips.
std::string plain(std::string_view word) {
  std::string text;
  for (char c : word)
    text += c == '_' || c == ' ' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}
}  // namespace

std::string suggestion(std::string_view wrong, const std::vector<std::string>& known) {
  if (known.empty()) return {};
  const std::string word = plain(wrong.substr(0, 64));
  const std::string* best = nullptr;
  int least = std::max<int>(1, static_cast<int>(word.size()) / 3) + 1;
  for (const std::string& name : known) {
    const std::string candidate = plain(name);
    int distance = editDistance(word, candidate);
    // A word that was cut short or drawn out, such as `res` or `velocities`, is near too.
    const std::size_t shorter = std::min(word.size(), candidate.size());
    if (shorter >= 3 && word.compare(0, shorter, candidate, 0, shorter) == 0)
      distance = std::min(distance, 1);
    if (distance < least) {
      least = distance;
      best = &name;
    }
  }
  if (best) return "did you mean `" + *best + "`?";
  std::string text = "known: ";
  for (std::size_t k = 0; k < known.size(); ++k) text += (k ? ", " : "") + known[k];
  return text;
}

}  // namespace smokebox
