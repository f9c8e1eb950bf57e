// What the commands that make films do alike around them.
#pragma once
#include <string>
#include <vector>

namespace smokebox {

/// The file in the folder renders/, which is made. Throws IoError.
std::string inRenders(const std::string& file);

/// Throws UsageError if one of the outputs is an H.264 film and the size is odd.
void refuseOddSize(const std::vector<std::string>& outputs, int width, int height);

/// The last line on standard error: what was written, and how fast.
void tellDone(const std::vector<std::string>& outputs, long frames, double seconds);

}  // namespace smokebox
