// The program `smokebox`. What draws is in a second program beside it, for the libraries it needs take long
// to load.
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "app/commands.h"
#include "app/program.h"
#include "base/errors.h"

namespace {

using namespace smokebox;

/// Goes on in the program that draws, with the same arguments; does not come back.
[[noreturn]] void becomeFilmProgram(char** argv) {
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "smokebox-film";
  execv(program.c_str(), argv);
  throw IoError(program.string() + ": " + std::strerror(errno));
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram(argc, argv, [&](const Command& command) -> int {
    if (const auto* shown = std::get_if<ShowText>(&command)) {
      std::fputs(shown->text.c_str(), stdout);
      return 0;
    }
    if (const auto* simulate = std::get_if<SimulateOptions>(&command)) return runSimulate(*simulate);
    if (const auto* check = std::get_if<CheckOptions>(&command)) return runCheck(*check);
    if (const auto* plan = std::get_if<PlanOptions>(&command)) return runPlan(*plan);
    becomeFilmProgram(argv);
  });
}
