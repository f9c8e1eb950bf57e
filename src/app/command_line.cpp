#include "app/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/threads.h"
#include "scene/nearest.h"

namespace smokebox {

namespace {

constexpr int kMaxThreads = 256;
constexpr int kMaxPixels = 16384;  // along a side of a picture

/// CLI11 would only say that the word was not expected.
void refuseUnknownCommand(const CLI::App& app, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), word) == names.end())
    throw UsageError("unknown command '" + word + "'; " + suggestion(word, names));
}

std::string checkSetting(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return "must be KEY=VALUE, not '" + text + "'";
  return {};
}

/// Two whole numbers with `separator` between them; a CLI11 error names the option.
std::pair<long, long> numberPair(const std::string& option, const std::string& text, char separator,
                                 const std::string& form) {
  const auto number = [&](const std::string& digits) {
    if (digits.empty() || digits.size() > 9 ||
        !std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; }))
      throw UsageError(option + ": must be " + form + ", not '" + text + "'");
    return std::stol(digits);
  };
  const std::size_t middle = text.find(separator);
  if (middle == std::string::npos) throw UsageError(option + ": must be " + form + ", not '" + text + "'");
  return {number(text.substr(0, middle)), number(text.substr(middle + 1))};
}

void addSettings(CLI::App& command, std::vector<std::string>& settings) {
  command
      .add_option("--set", settings,
                  "Override a key of the scene, such as fluid.vorticity=0 (may be repeated)")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all()
      ->check(CLI::Validator(
          std::function<std::string(std::string&)>([](std::string& s) { return checkSetting(s); }), ""));
}

void addRunOptions(CLI::App& command, RunOptions& options) {
  command.add_option("scene", options.scene, "Scene file (YAML)")->required()->type_name("SCENE");
  addSettings(command, options.settings);
  command
      .add_option("--threads", options.threads, "Threads of the simulation; the result does not depend on it")
      ->type_name("N")
      ->check(CLI::Range(1, kMaxThreads))
      ->capture_default_str();
  command.add_option("--stats", options.stats, "Write the figures of the run as JSON")->type_name("FILE");
}

void addPictureOptions(CLI::App& command, PictureOptions& options) {
  command.add_option("--gl", options.gl, "Way to OpenGL: osmesa or egl; default: osmesa if it is built in")
      ->type_name("NAME")
      ->check(CLI::IsMember({"osmesa", "egl"}));
}

}  // namespace

std::string programVersion() { return SMOKEBOX_VERSION; }

Command parseCommandLine(int argc, const char* const* argv) {
  CLI::App app("Smoke around solids: a scene file becomes a film", "smokebox");
  app.set_version_flag("--version", "smokebox " + programVersion());
  app.set_help_flag("-h,--help", "Show this help");
  app.require_subcommand(0, 1);

  RenderOptions render;
  std::string frames, size;
  double at = 0;
  render.threads = hardwareThreads();
  CLI::App* renderCommand =
      app.add_subcommand("render", "Simulate a scene and draw it as a film, frames or a still");
  addRunOptions(*renderCommand, render);
  addPictureOptions(*renderCommand, render);
  renderCommand
      ->add_option("-o,--output", render.outputs,
                   "Where to: .mp4 (H.264), .mkv (FFV1, lossless), folder/%05d.png (frames), .png (a still), "
                   "- (Y4M on "
                   "standard output); may be repeated. Default: renders/<scene>.mp4")
      ->type_name("OUT")
      ->expected(1)
      ->take_all();
  CLI::Option* atOption =
      renderCommand->add_option("--at", at, "Time of a still in seconds; default: the last frame")
          ->type_name("T");
  renderCommand->add_option("--frames", frames, "Draw only these frames, counted from 0; both are drawn")
      ->type_name("A-B");
  renderCommand->add_option("--size", size, "Size of the picture in pixels; overrides output.size")
      ->type_name("WxH");
  renderCommand->add_flag("-y", render.replace, "Replace files that are there");
  renderCommand->add_flag("--quiet", render.quiet, "No progress");

  SimulateOptions simulate;
  simulate.threads = hardwareThreads();
  long steps = 0;
  CLI::App* simulateCommand = app.add_subcommand("simulate", "Run a scene without pictures");
  addRunOptions(*simulateCommand, simulate);
  CLI::Option* stepsOption =
      simulateCommand->add_option("--steps", steps, "Number of steps; replaces the duration")
          ->type_name("N")
          ->check(CLI::Range(1L, 1'000'000'000L));

  CheckOptions check;
  CLI::App* checkCommand = app.add_subcommand("check", "Read and check scenes; one line per problem");
  checkCommand->add_option("scene", check.scenes, "Scene files (YAML)")->required()->type_name("SCENE...");

  PlanOptions plan;
  CLI::App* planCommand = app.add_subcommand("plan", "Say what a scene will model, and what not");
  planCommand->add_option("scene", plan.scene, "Scene file (YAML)")->required()->type_name("SCENE");
  addSettings(*planCommand, plan.settings);

  if (argc > 1 && argv[1][0] != '-') refuseUnknownCommand(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return ShowText{app.help()};
  } catch (const CLI::CallForVersion&) {
    return ShowText{"smokebox " + programVersion() + "\n"};
  } catch (const CLI::ExtrasError&) {  // its own message has them backwards
    std::string words;
    for (const std::string& word : app.remaining(true)) words += " " + word;
    throw UsageError("not expected:" + words + "; see smokebox " + argv[1] + " --help");
  } catch (const CLI::ParseError& error) {
    const auto commands = app.get_subcommands();
    throw UsageError(std::string(error.what()) + "; see smokebox " +
                     (commands.empty() ? "" : commands.front()->get_name() + " ") + "--help");
  }

  if (renderCommand->parsed()) {
    if (!frames.empty())
      render.frames = frames.find('-') == std::string::npos
                          ? numberPair("--frames", frames + "-" + frames, '-', "A-B")
                          : numberPair("--frames", frames, '-', "A-B");
    if (render.frames && render.frames->first > render.frames->second)
      throw UsageError("--frames: " + frames + " ends before it begins");
    if (!size.empty()) {
      const auto [width, height] = numberPair("--size", size, 'x', "WIDTHxHEIGHT");
      if (width < 1 || height < 1 || width > kMaxPixels || height > kMaxPixels)
        throw UsageError("--size: " + size + " is not between 1x1 and 16384x16384");
      // As a setting it goes through the same checks as the scene's own size.
      render.settings.push_back("output.size=[" + std::to_string(width) + ", " + std::to_string(height) +
                                "]");
    }
    if (atOption->count()) {
      if (!std::isfinite(at) || at < 0) throw UsageError("--at: must be a time from 0, in seconds");
      render.at = at;
    }
    for (std::size_t k = 0; k < render.outputs.size(); ++k)
      if (std::find(render.outputs.begin(), render.outputs.begin() + k, render.outputs[k]) !=
          render.outputs.begin() + k)
        throw UsageError("-o " + render.outputs[k] + ": is named twice");
    return render;
  }
  if (simulateCommand->parsed()) {
    if (stepsOption->count()) simulate.steps = steps;
    return simulate;
  }
  if (checkCommand->parsed()) return check;
  if (planCommand->parsed()) return plan;
  return ShowText{app.help()};
}

}  // namespace smokebox
