// Every error that a user can meet. Library code throws these; only main() turns them into an exit status.
#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace smokebox {

/// A place in a text file; line and column count from 1, 0 means unknown.
struct SourcePlace {
  std::string file;
  int line = 0, column = 0;
  /// "file:line:column", without the parts that are unknown.
  std::string text() const;
};

/// One thing that is wrong with a scene, or worth a warning.
struct Problem {
  SourcePlace place;
  std::string message;
  std::string hint;  // may be empty
  bool warning = false;
  /// "file:line:column: message (hint)".
  std::string text() const;
};

/// Exit status of the program, section 2 of the design.
enum class ExitStatus {
  ok = 0,
  failed = 1,
  usage = 2,
  badScene = 3,
  inputOutput = 4,
  imagesDiffer = 5,
  interrupted = 130
};

class Error : public std::runtime_error {
 public:
  Error(ExitStatus status, const std::string& message) : std::runtime_error(message), status_(status) {}
  ExitStatus status() const { return status_; }

 private:
  ExitStatus status_;
};

/// The scene is wrong: carries all problems found, not only the first.
class SceneError : public Error {
 public:
  explicit SceneError(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// A file that cannot be read, written or renamed; a full disk.
struct IoError : Error {
  explicit IoError(const std::string& message) : Error(ExitStatus::inputOutput, message) {}
};
/// OpenGL cannot be had, or a shader does not compile.
struct GlError : Error {
  explicit GlError(const std::string& message) : Error(ExitStatus::failed, message) {}
};
/// The encoder refuses.
struct VideoError : Error {
  explicit VideoError(const std::string& message) : Error(ExitStatus::failed, message) {}
};
/// The simulation went wrong: says at which step, where and what to try.
struct SimulationError : Error {
  explicit SimulationError(const std::string& message) : Error(ExitStatus::failed, message) {}
};
struct UsageError : Error {
  explicit UsageError(const std::string& message) : Error(ExitStatus::usage, message) {}
};
/// Ctrl-C.
struct Interrupted : Error {
  Interrupted() : Error(ExitStatus::interrupted, "interrupted") {}
};

/// Trips on a bug of ours: names the invariant that does not hold.
void checkInvariant(bool holds, const char* invariant);

}  // namespace smokebox
