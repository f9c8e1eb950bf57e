// What both programs do around a command: errors become a line on standard error and an exit status.
#pragma once
#include <functional>

#include "app/command_line.h"

namespace smokebox {

/// Parses the command line, hands the command on, and returns the exit status of the process.
int runProgram(int argc, const char* const* argv, const std::function<int(const Command&)>& run);

}  // namespace smokebox
