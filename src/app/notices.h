// What a run tells its user by the way, on standard error.
#pragma once
#include <string>
#include <vector>

namespace smokebox {

/// One line each; `label` says which of several runs it is, and may be empty.
void printNotices(const std::vector<std::string>& notices, const std::string& label = {});

}  // namespace smokebox
