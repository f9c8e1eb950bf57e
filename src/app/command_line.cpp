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
}

void addStats(CLI::App& command, RunOptions& options) {
  command.add_option("--stats", options.stats, "Write the figures of the run as JSON")->type_name("FILE");
}

/// Options whose text is looked at when all has been parsed.
struct FilmTexts {
  std::string frames, size;
};

void addFilmOptions(CLI::App& command, FilmOptions& options, FilmTexts& texts, const std::string& byDefault) {
  options.threads = hardwareThreads();
  addRunOptions(command, options);
  command
      .add_option("-o,--output", options.outputs,
                  "Where to: .mp4 (H.264), .mkv (FFV1, lossless), folder/%05d.png (frames), .png (a still), "
                  "- (Y4M on standard output); may be repeated. Default: " +
                      byDefault)
      ->type_name("OUT")
      ->expected(1)
      ->take_all();
  command.add_option("--frames", texts.frames, "Draw only these frames, counted from 0; both are drawn")
      ->type_name("A-B");
  command.add_option("--size", texts.size, "Size of the picture in pixels; overrides output.size")
      ->type_name("WxH");
  command.add_flag("-y", options.replace, "Replace files that are there");
  command.add_flag("--quiet", options.quiet, "No progress");
  command.add_option("--gl", options.gl, "Way to OpenGL: osmesa or egl; default: osmesa if it is built in")
      ->type_name("NAME")
      ->check(CLI::IsMember({"osmesa", "egl"}));
}

void takeFilmTexts(const FilmTexts& texts, FilmOptions& options) {
  const auto& [frames, size] = texts;
  if (!frames.empty())
    options.frames = frames.find('-') == std::string::npos
                         ? numberPair("--frames", frames + "-" + frames, '-', "A-B")
                         : numberPair("--frames", frames, '-', "A-B");
  if (options.frames && options.frames->first > options.frames->second)
    throw UsageError("--frames: " + frames + " ends before it begins");
  if (!size.empty()) {
    const auto [width, height] = numberPair("--size", size, 'x', "WIDTHxHEIGHT");
    if (width < 1 || height < 1 || width > kMaxPixels || height > kMaxPixels)
      throw UsageError("--size: " + size + " is not between 1x1 and 16384x16384");
    // As a setting it goes through the same checks as the scene's own size.
    options.settings.push_back("output.size=[" + std::to_string(width) + ", " + std::to_string(height) + "]");
  }
  for (std::size_t k = 0; k < options.outputs.size(); ++k)
    if (std::find(options.outputs.begin(), options.outputs.begin() + k, options.outputs[k]) !=
        options.outputs.begin() + k)
      throw UsageError("-o " + options.outputs[k] + ": is named twice");
}

void checkTime(const std::string& option, double time) {
  if (!std::isfinite(time) || time < 0) throw UsageError(option + ": must be a time from 0, in seconds");
}

}  // namespace

std::string programVersion() { return SMOKEBOX_VERSION; }

Command parseCommandLine(int argc, const char* const* argv) {
  CLI::App app("Smoke around solids: a scene file becomes a film", "smokebox");
  app.set_version_flag("--version", "smokebox " + programVersion());
  app.set_help_flag("-h,--help", "Show this help");
  app.require_subcommand(0, 1);

  RenderOptions render;
  FilmTexts renderTexts;
  double at = 0;
  CLI::App* renderCommand =
      app.add_subcommand("render", "Simulate a scene and draw it as a film, frames or a still");
  addFilmOptions(*renderCommand, render, renderTexts, "renders/<scene>.mp4");
  addStats(*renderCommand, render);
  CLI::Option* atOption =
      renderCommand->add_option("--at", at, "Time of a still in seconds; default: the last frame")
          ->type_name("T");

  CompareOptions compare;
  FilmTexts compareTexts;
  CLI::App* compareCommand = app.add_subcommand(
      "compare", "Run a scene under several values of a key, in step, as panels of one film");
  addFilmOptions(*compareCommand, compare, compareTexts, "renders/<scene>-compare.mp4");
  compareCommand
      ->add_option("--vary", compare.varied,
                   "Two to nine values of a key, such as fluid.vorticity=0.3,0; repeated: every combination")
      ->type_name("KEY=V1,V2")
      ->required()
      ->expected(1)
      ->take_all();
  compareCommand
      ->add_option("--stills", compare.stills,
                   "Times of stills in seconds; they are named after the film, or after a .png of -o")
      ->type_name("T1,T2")
      ->delimiter(',')
      ->expected(1)
      ->take_all();
  compareCommand->add_flag("--diff", compare.difference,
                           "One panel more: where the others differ from the first");

  SimulateOptions simulate;
  simulate.threads = hardwareThreads();
  long steps = 0;
  CLI::App* simulateCommand = app.add_subcommand("simulate", "Run a scene without pictures");
  addRunOptions(*simulateCommand, simulate);
  addStats(*simulateCommand, simulate);
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

  DiffOptions diff;
  CLI::App* diffCommand =
      app.add_subcommand("diff", "Compare two pictures or films with the tolerance of the golden tests");
  diffCommand->add_option("a", diff.a, "Picture (PNG) or film")->required()->type_name("A");
  diffCommand->add_option("b", diff.b, "What it is compared with")->required()->type_name("B");
  diffCommand
      ->add_option("-o,--output", diff.output,
                   "Where they differ: .png (of films: the worst frame); of films also .mp4, .mkv, "
                   "folder/%05d.png")
      ->type_name("OUT");
  diffCommand->add_flag("-y", diff.replace, "Replace files that are there");

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
    takeFilmTexts(renderTexts, render);
    if (atOption->count()) {
      checkTime("--at", at);
      render.at = at;
    }
    return render;
  }
  if (compareCommand->parsed()) {
    takeFilmTexts(compareTexts, compare);
    for (const double time : compare.stills) checkTime("--stills", time);
    return compare;
  }
  if (simulateCommand->parsed()) {
    if (stepsOption->count()) simulate.steps = steps;
    return simulate;
  }
  if (checkCommand->parsed()) return check;
  if (planCommand->parsed()) return plan;
  if (diffCommand->parsed()) return diff;
  return ShowText{app.help()};
}

}  // namespace smokebox
