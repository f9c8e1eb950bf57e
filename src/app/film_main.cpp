// The program `smokebox-film`: the commands that draw. `smokebox` hands over to it.
#include "app/commands.h"
#include "app/program.h"
#include "base/errors.h"

int main(int argc, char** argv) {
  using namespace smokebox;
  return runProgram(argc, argv, [](const Command& command) -> int {
    if (const auto* render = std::get_if<RenderOptions>(&command)) return runRender(*render);
    if (const auto* compare = std::get_if<CompareOptions>(&command)) return runCompare(*compare);
    if (const auto* diff = std::get_if<DiffOptions>(&command)) return runDiff(*diff);
    throw UsageError("this program only draws; start it through smokebox");
  });
}
