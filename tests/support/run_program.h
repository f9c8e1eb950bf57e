// Runs the program as a user would, and keeps what it said.
#pragma once
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support/temporary_folder.h"

namespace smokebox {

struct RunResult {
  int status = -1;  // exit status; 1000 + n if signal n killed it
  std::string out, err;
};

/// One run of the program in a folder of its own.
class ProgramRun {
 public:
  /// `output`: where standard output goes; empty: it is kept.
  ProgramRun(std::vector<std::string> arguments, const std::filesystem::path& folder,
             std::string output = "") {
    arguments.insert(arguments.begin(), SMOKEBOX_PROGRAM);
    if (output.empty()) output = keep_ / "out";
    outFile_ = output;
    const std::string errFile = keep_ / "err";
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    process_ = fork();
    if (process_ < 0) throw std::runtime_error("fork");
    if (process_ == 0) {
      const int out = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      const int err = open(errFile.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      if (out < 0 || err < 0 || dup2(out, 1) < 0 || dup2(err, 2) < 0 || chdir(folder.c_str()) != 0) _exit(99);
      setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
      execv(argv[0], argv.data());
      _exit(98);
    }
  }
  ~ProgramRun() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  ProgramRun(const ProgramRun&) = delete;
  ProgramRun& operator=(const ProgramRun&) = delete;

  void signal(int number) const { kill(process_, number); }
  std::string errSoFar() const { return fileText(keep_ / "err"); }
  /// False if it did not come true within a minute, or the process ended before.
  bool waitUntil(const std::function<bool()>& condition) {
    using namespace std::chrono_literals;
    for (const auto end = std::chrono::steady_clock::now() + 60s; std::chrono::steady_clock::now() < end;) {
      if (condition()) return true;
      siginfo_t info = {};
      if (waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
          info.si_pid != 0)
        return condition();
      std::this_thread::sleep_for(5ms);
    }
    return false;
  }
  RunResult wait() {
    int code = 0;
    waitpid(process_, &code, 0);
    process_ = 0;
    RunResult result;
    result.status = WIFEXITED(code) ? WEXITSTATUS(code) : 1000 + WTERMSIG(code);
    if (std::filesystem::is_regular_file(outFile_)) result.out = fileText(outFile_);
    result.err = fileText(keep_ / "err");
    return result;
  }

 private:
  TemporaryFolder keep_;
  std::string outFile_;
  pid_t process_ = 0;
};

inline RunResult runProgram(std::vector<std::string> arguments, const std::filesystem::path& folder,
                            std::string output = "") {
  return ProgramRun(std::move(arguments), folder, std::move(output)).wait();
}

/// A scene that runs in a moment: 15 frames at 30 frames/s, 64 x 32 pixels.
inline const char* kSmallScene = R"(title: A small scene
domain: {size: [2, 1], resolution: 32}
walls: {left: {inflow: [1, 0]}, right: open}
time: {step: 1/60, duration: 0.5}
smoke:
  sources:
    - {shape: {circle: {center: [0.3, 0.5], radius: 0.1}}, rate: 4}
solids:
  - {name: post, shape: {circle: {radius: 0.15}}, position: [1, 0.5], report: true}
probes:
  - {name: p, at: [1.5, 0.5]}
output: {size: [64, 32], fps: 30}
)";

}  // namespace smokebox
