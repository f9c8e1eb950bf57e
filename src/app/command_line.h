// What the user typed, as plain data. The only place that knows CLI11.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace smokebox {

/// What every command that runs a scene takes.
struct RunOptions {
  std::string scene;
  std::vector<std::string> settings;  // "key=value", in order
  int threads = 1;
  std::string stats;  // file for the figures; empty: none
};

/// What every command that makes a film of it takes.
struct FilmOptions : RunOptions {
  std::vector<std::string> outputs;             // empty: a name of the command's own in renders/
  std::optional<std::pair<long, long>> frames;  // first and last, both drawn
  bool replace = false, quiet = false;
  std::string gl;  // "osmesa" or "egl"; empty: what the build has
};

struct RenderOptions : FilmOptions {
  std::optional<double> at;  // s
};

struct CompareOptions : FilmOptions {
  std::vector<std::string> varied;  // "key=value,value"
  std::vector<double> stills;       // s
  bool difference = false;          // a panel of it
};

struct SimulateOptions : RunOptions {
  std::optional<long> steps;
};

struct CheckOptions {
  std::vector<std::string> scenes;
};

struct PlanOptions {
  std::string scene;
  std::vector<std::string> settings;
};

struct DiffOptions {
  std::string a, b;    // pictures or films
  std::string output;  // empty: none
  bool replace = false;
};

/// --help and --version: nothing to do but to print this.
struct ShowText {
  std::string text;
};

using Command = std::variant<ShowText, RenderOptions, CompareOptions, SimulateOptions, CheckOptions,
                             PlanOptions, DiffOptions>;

/// Throws UsageError.
Command parseCommandLine(int argc, const char* const* argv);

/// "1.2.3".
std::string programVersion();

}  // namespace smokebox
