#include "app/program.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include "base/errors.h"

namespace smokebox {

namespace {

int status(ExitStatus value) { return static_cast<int>(value); }

/// Runs the command; what it printed may still be in the buffer, and a full disk shows only when that is
/// written.
int runAndFlush(int argc, const char* const* argv, const std::function<int(const Command&)>& run) {
  const int result = run(parseCommandLine(argc, argv));
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout))
    throw IoError(std::string("standard output: ") + std::strerror(errno ? errno : EIO));
  return result;
}

}  // namespace

int runProgram(int argc, const char* const* argv, const std::function<int(const Command&)>& run) {
  // A reader that has gone shows as a failed write, and is reported like any other.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return runAndFlush(argc, argv, run);
  } catch (const SceneError& error) {
    std::fprintf(stderr, "%s\n", error.what());  // lines that already begin with a place
    return status(error.status());
  } catch (const Error& error) {
    std::fprintf(stderr, "smokebox: %s\n", error.what());
    return status(error.status());
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "smokebox: out of memory; a lower domain.resolution takes less\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "smokebox: %s\n", error.what());
  }
  return status(ExitStatus::failed);
}

}  // namespace smokebox
