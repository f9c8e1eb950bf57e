// Ctrl-C: the first asks the running command to stop and to clean up, the second kills the process.
#pragma once

namespace smokebox {

/// From here on SIGINT and SIGTERM are only noted.
void catchInterrupts();
/// Throws Interrupted if one has come.
void throwIfInterrupted();

}  // namespace smokebox
