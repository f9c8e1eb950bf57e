#include "golden/set/golden_run.h"

#include <cstdio>
#include <stdexcept>

#include "image/png.h"
#include "support/run_program.h"

namespace smokebox::golden {

std::string Variant::name() const {
  return std::string(nameOf(backend)) + "-" + std::to_string(threads) +
         (threads == 1 ? "-thread" : "-threads");
}

std::vector<Image> draw(const Row& row, const Variant& variant, const std::vector<std::string>& more) {
  const std::vector<long> frames = row.frames();
  std::vector<std::string> arguments{
      "render",    row.scenePath(),
      "--frames",  std::to_string(frames.front()) + "-" + std::to_string(frames.back()),
      "--gl",      nameOf(variant.backend),
      "--threads", std::to_string(variant.threads),
      "-o",        "%05d.png",
      "--quiet"};
  for (const auto& settings : {row.settings, more})
    for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
  if (row.size)
    arguments.insert(arguments.end(),
                     {"--size", std::to_string((*row.size)[0]) + "x" + std::to_string((*row.size)[1])});
  TemporaryFolder folder;
  const RunResult run = runProgram(arguments, folder.path());
  if (run.status != 0)
    throw std::runtime_error(row.name + ": the program ended with status " + std::to_string(run.status) +
                             ": " + run.err);
  std::vector<Image> pictures;
  for (const long frame : frames) {
    char name[32];
    std::snprintf(name, sizeof name, "%05ld.png", frame);
    pictures.push_back(readPng(folder / name));
  }
  return pictures;
}

}  // namespace smokebox::golden
