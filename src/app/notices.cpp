#include "app/notices.h"

#include <cstdio>

namespace smokebox {

void printNotices(const std::vector<std::string>& notices, const std::string& label) {
  const std::string start = "smokebox: warning: " + (label.empty() ? label : label + ": ");
  for (const std::string& notice : notices) std::fprintf(stderr, "%s%s\n", start.c_str(), notice.c_str());
}

}  // namespace smokebox
