// Bad input of every kind: each test gives a text whose fault is known, and the place and words that its
// message must have.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>

#include "scene/document.h"

namespace smokebox {
namespace {

/// All problems, one a line; also of texts that cannot even be parsed.
std::string problemsOf(const std::string& text) {
  std::string all;
  auto add = [&](const std::vector<Problem>& problems) {
    for (const Problem& problem : problems) all += problem.text() + "\n";
  };
  try {
    add(SceneDocument::parse(text, "s.yaml").problems());
  } catch (const SceneError& error) {
    add(error.problems());
  }
  return all;
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

const std::string kDomain = "domain: {size: [2, 1], resolution: 64}\n";

/// The text is wrong in just one way, and the message has all these parts.
void expectFault(const std::string& text, const std::vector<std::string>& parts) {
  const std::string problems = problemsOf(text);
  EXPECT_EQ(lines(problems), 1u) << problems;
  for (const std::string& part : parts)
    EXPECT_NE(problems.find(part), std::string::npos) << "lacks: " << part << "\ngot: " << problems;
}

TEST(SceneErrors, APlainSceneHasNone) {
  // Truth: nothing but the domain is needed.
  EXPECT_EQ(problemsOf(kDomain), "");
}

TEST(SceneErrors, TemperaturesThatMakeNoSenseAreReported) {
  // Truth: unknown keys, periodic sides, numbers that are none; and a warning for what has no effect.
  const std::string scene = kDomain + "gravity: [0, -1]\n";
  expectFault(scene + "temperature: {diffusion: 1}\n", {"s.yaml:3:15", "diffusion", "diffusivity"});
  expectFault(scene + "temperature: {diffusivity: -1}\n", {"s.yaml:3:28", "0 or larger"});
  expectFault(scene + "temperature: {diffusivity: 1, walls: {front: 1}}\n", {"s.yaml:3:39", "front"});
  expectFault(
      scene + "walls: {left: periodic, right: periodic}\ntemperature: {diffusivity: 1, walls: {left: 1}}\n",
      {"s.yaml:4:45", "periodic"});
  expectFault(scene + "temperature: {start: 1/(x-x)}\n", {"s.yaml:3:22", "temperature.start", "finite"});
  expectFault(scene + "temperature: {diffusivity: 1, walls: {left: 1/(t-t)}}\n",
              {"s.yaml:3:45", "temperature.walls.left", "finite"});
  expectFault(scene + "temperature: {walls: {left: 1}}\n", {"s.yaml:3:29", "warning", "warms nothing"});
  expectFault(kDomain + "temperature: {start: x}\n", {"s.yaml:2:", "warning", "gravity"});
  expectFault(scene + "temperature: {}\nevents: [{at: 1, set: {temperature.start: 1}}]\n",
              {"s.yaml:4:", "cannot change during a run"});
  expectFault(scene + "fluid: {}\nevents: [{at: 1, set: {temperature.expansion: 1}}]\n",
              {"s.yaml:4:", "no temperature"});
  EXPECT_EQ(problemsOf(scene +
                       "temperature: {start: 20 + y, reference: 20, diffusivity: 1e-3, walls: {left: 1}}\n"),
            "");
}

TEST(SceneErrors, FilesThatCannotBeReadAreInputOutputErrors) {
  // Truth: status 4 for what the file system refuses.
  for (const char* name : {"/nowhere/at/all.yaml", "/tmp"}) {
    try {
      SceneDocument::load(name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::inputOutput);
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
    }
  }
}

TEST(SceneErrors, ReadsWhatIsInAFile) {
  // Truth: the same spec as from the text, named after the file.
  const auto path =
      std::filesystem::temp_directory_path() / ("smokebox-" + std::to_string(getpid()) + ".yaml");
  std::ofstream(path) << kDomain;
  const SceneSpec spec = SceneDocument::load(path).spec();
  std::filesystem::remove(path);
  EXPECT_EQ(spec.domain.grid.nx, 64);
  EXPECT_EQ(spec.name, path.stem().string());
}

TEST(SceneErrors, TextsThatAreNoScene) {
  // Truth: status 3, with a place, for what is read but makes no sense.
  expectFault("", {"s.yaml:1:1: ", "empty"});
  expectFault("# nothing\n\n", {"s.yaml:1:1: ", "empty"});
  expectFault("domain: {size: [2, 1], resolution: 64\n", {"s.yaml:", "not YAML"});
  expectFault("domain: [1, 2\nwalls: }", {"s.yaml:2:", "not YAML"});
  expectFault("a: b: c\n", {"s.yaml:1:5: not YAML"});
  expectFault("- 1\n- 2\n", {"s.yaml:1:1: ", "a scene must be a map", "a list"});
  expectFault("just words\n", {"s.yaml:1:1: ", "a scene must be a map", "`just words`"});
  expectFault(std::string("\x7f\0ELF", 5), {"s.yaml:1:1: ", "not YAML"});
  expectFault(kDomain + "---\ntitle: b\n", {"s.yaml:3:1: ", "second document"});
  expectFault("[1, 2]: 3\n" + kDomain, {"s.yaml:1:1: ", "a key must be a word"});
  try {
    SceneDocument::parse(kDomain + "bogus: 1", "s.yaml").spec();
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::badScene);
  }
}

TEST(SceneErrors, BombsAreRefusedQuickly) {
  // Truth: nine levels of nine aliases are 9^9 values; a self-alias is endless; 100000 brackets are no scene.
  const auto start = std::chrono::steady_clock::now();
  std::string bomb = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int k = 1; k < 10; ++k) {
    const std::string last = "*a" + std::to_string(k - 1);
    bomb += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " [" + last;
    for (int n = 0; n < 8; ++n) bomb += ", " + last;
    bomb += "]\n";
  }
  expectFault(bomb, {"s.yaml:7:", "1000000 values", "alias"});
  expectFault("a: &a [1, *a]\n", {"s.yaml:1:11: ", "an alias stands inside"});
  expectFault("a: " + std::string(100000, '['), {"s.yaml:1:", "deeper than 64 levels"});
  std::string blocks;
  for (int k = 0; k < 100; ++k) blocks += std::string(k, ' ') + "a:\n";
  expectFault(blocks, {"s.yaml:65:", "deeper than 64 levels"});
  std::string chain = "a0: &a0 [1]\n";
  for (int k = 1; k < 100; ++k)
    chain += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " [*a" + std::to_string(k - 1) + "]\n";
  expectFault(chain, {"deeper than 64 levels"});
  expectFault("# " + std::string(9 << 20, 'x'), {"8 MiB"});
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
}

TEST(SceneErrors, UnknownKeysSuggestTheNearest) {
  // Truth: one slip of a letter at every level of the format.
  expectFault(kDomain + "fluyd: {}\n", {"s.yaml:2:1: unknown key `fluyd`", "did you mean `fluid`?"});
  expectFault("domain: {size: [2, 1], resolutoin: 8, resolution: 64}\n",
              {"s.yaml:1:24: unknown key `resolutoin` in `domain`", "did you mean `resolution`?"});
  expectFault(kDomain + "fluid:\n  vortcity: 1\n",
              {"s.yaml:3:3: unknown key `vortcity` in `fluid`", "`vorticity`"});
  expectFault(kDomain + "solids:\n- shape: {circle: {radius: 0.1, centre: [1, 1]}}\n",
              {"s.yaml:3:33: ", "in `solids.0.shape.circle`", "did you mean `center`?"});
  expectFault(kDomain + "method: {foo: 1}\n",
              {"s.yaml:2:10: unknown key `foo`", "known: tolerance, max_iterations"});
  expectFault(kDomain + "walls: {left: no_slip}\n", {"s.yaml:2:15: ", "did you mean `no-slip`?"});
  expectFault(kDomain + "walls: {left: {no_slip: [0, 1]}}\n", {"s.yaml:2:16: ", "did you mean `no-slip`?"});
  expectFault(kDomain + "view: {layers: [smoke, presure]}\n", {"s.yaml:2:24: unknown layer", "`pressure`"});
  expectFault(kDomain + "view: {layers: [{smoke: {range: [0, 1]}}]}\n", {"s.yaml:2:26: unknown key `range`"});
  expectFault(kDomain + "smoke: {sources: [{shape: {cirle: {radius: 1}}}]}\n",
              {"s.yaml:2:28: unknown key `cirle`", "did you mean `circle`?"});
}

TEST(SceneErrors, KeysThatAreGivenTwiceNameBothPlaces) {
  // Truth: YAML forbids it, yaml-cpp takes it.
  expectFault(kDomain + "title: a\ntitle: b\n", {"s.yaml:3:1: the key `title` is given twice", "s.yaml:2:1"});
  expectFault(kDomain + "fluid: {density: 1, density: 2}\n", {"s.yaml:2:21: ", "twice", "s.yaml:2:9"});
  expectFault(kDomain +
                  "solids:\n- {name: a, shape: {circle: {radius: .1}}, position: [1, .5]}\n"
                  "- {name: a, shape: {circle: {radius: .1}}, position: [1, .5]}\n",
              {"s.yaml:4:10: a second solid named `a`"});
}

TEST(SceneErrors, WrongTypesAndNumbers) {
  // Truth: what was expected, and what was there.
  expectFault(kDomain + "fluid: {density: [1]}\n",
              {"s.yaml:2:18: `fluid.density` must be a number, got a list"});
  expectFault(kDomain + "fluid: 3\n", {"s.yaml:2:8: `fluid` must be a map", "got `3`"});
  expectFault(kDomain + "solids: {a: 1}\n", {"s.yaml:2:9: `solids` must be a list, got a map"});
  expectFault(kDomain + "gravity: -9.81\n",
              {"s.yaml:2:10: `gravity` must be two numbers, [x, y], got `-9.81`"});
  expectFault(kDomain + "gravity: [0, 1, 2]\n", {"s.yaml:2:10: ", "a list of 3"});
  expectFault(kDomain + "fluid: {density: .nan}\n", {"s.yaml:2:18: ", "finite number, got `.nan`"});
  expectFault(kDomain + "fluid: {density: inf}\n", {"s.yaml:2:18: ", "finite number"});
  expectFault(kDomain + "fluid: {density: 1/0}\n", {"s.yaml:2:18: ", "finite number, got `1/0`"});
  expectFault(kDomain + "fluid: {density: 1e999}\n", {"s.yaml:2:18: ", "finite number"});
  expectFault(kDomain + "fluid: {density: heavy}\n", {"s.yaml:2:18: ", "must be a number, got `heavy`"});
  expectFault(kDomain + "fluid: {density: -1}\n", {"s.yaml:2:18: ", "larger than 0, got `-1`"});
  expectFault(kDomain + "fluid: {viscosity: -1e-9}\n", {"s.yaml:2:20: ", "0 or larger"});
  expectFault("domain: {size: [-2, 1], resolution: 64}\n",
              {"s.yaml:1:17: `domain.size.0` must be larger than 0"});
  expectFault("domain: {size: [2, 1], resolution: 64.5}\n", {"s.yaml:1:36: ", "whole number"});
  expectFault("domain: {size: [2, 1], resolution: 4}\n", {"s.yaml:1:36: ", "at least 8"});
  expectFault("domain: {size: [2, 1]}\n", {"s.yaml:1:9: `domain.resolution` is missing"});
  expectFault("title: x\n", {"s.yaml:1:1: `domain` is missing"});
  expectFault(kDomain + "smoke: {sources: [{shape: {circle: {radius: -0.1}}}]}\n",
              {"s.yaml:2:45: ", "larger than 0"});
  expectFault(kDomain + "solids: [{shape: {box: {size: [0, 1]}}}]\n", {"s.yaml:2:32: ", "larger than 0"});
  expectFault(kDomain + "smoke: {sources: [{shape: {position: [1, 1]}}]}\n",
              {"s.yaml:2:27: ", "names no shape", "circle, ellipse, box"});
  expectFault(kDomain + "smoke: {sources: [{shape: {circle: {radius: 1}, box: {size: [1, 1]}}}]}\n",
              {"s.yaml:2:49: ", "two shapes at once", "union"});
  expectFault(kDomain + "solids: [{shape: {circle: {radius: 0.1}}, position: [1, 0.5], drag: 1.5}]\n",
              {"s.yaml:2:69: ", "between 0 and 1"});
  expectFault(kDomain + "solids: [{shape: {circle: {radius: 0.1}}, position: [1, 0.5], report: maybe}]\n",
              {"s.yaml:2:71: ", "true or false"});
  expectFault(kDomain + "view: {background: \"#12\"}\n", {"s.yaml:2:20: ", "a colour"});
  expectFault(kDomain + "view:\n  background: #123456\n", {"s.yaml:3:3: ", "a colour", "quotes"});
  expectFault(kDomain + "view: {layers: [{pressure: {range: [1, 0]}}]}\n", {"s.yaml:2:36: ", "[low, high]"});
  expectFault(kDomain + "output: {fps: 29.97}\n", {"s.yaml:2:15: ", "whole number between 1 and 240"});
  expectFault(kDomain + "output: {size: [0, 720]}\n", {"s.yaml:2:17: ", "whole number"});
  expectFault(kDomain + "method: {tolerance: 0}\n", {"s.yaml:2:21: ", "larger than 0 and below 1"});
  expectFault(kDomain + "method: baseline\n", {"s.yaml:2:9: ", "not supported"});
}

TEST(SceneErrors, ExpressionsSayWhatIsWrongWithThem) {
  // Truth: names that are not known, or not known there.
  expectFault(kDomain + "fluid: {velocity: [\"sinn(x)\", 0]}\n", {"s.yaml:2:20: ", "did you mean `sin`?"});
  expectFault(kDomain + "fluid: {velocity: [\"sin(t)\", 0]}\n", {"s.yaml:2:20: ", "`t` cannot be used here"});
  expectFault(kDomain + "fluid: {velocity: [\"log(x-1)\", 0]}\n",
              {"s.yaml:2:19: ", "not a finite number at x ="});
  expectFault(kDomain + "fluid: {velocity: [1]}\n", {"s.yaml:2:19: ", "a list of 2"});
  expectFault(kDomain + "walls: {left: {inflow: [\"1/x\", 0]}, right: open}\n",
              {"s.yaml:2:9: ", "not a finite number"});
  expectFault(
      kDomain + "solids: [{shape: {circle: {radius: .1}}, motion: {expression: {x: \"1/t\", y: .5}}}]\n",
      {"s.yaml:2:50: ", "not a finite number at t = 0"});
}

TEST(SceneErrors, PolygonsNameTheirEdges) {
  // Truth: a bow tie crosses itself; three points on a line have no area; two points are no polygon.
  const std::string head = kDomain + "solids: [{shape: {polygon: ";
  expectFault(head + "[[0.2, 0.2], [0.8, 0.8], [0.8, 0.2], [0.2, 0.8]]}}]\n", {"s.yaml:2:28: ", "edge"});
  expectFault(head + "[[0.2, 0.2], [0.5, 0.2], [0.8, 0.2]]}}]\n", {"s.yaml:2:28: "});
  expectFault(head + "[[0.2, 0.2], [0.5, 0.2]]}}]\n", {"s.yaml:2:28: ", "2 points", "at least 3"});
  expectFault(head + "[[0.2, 0.2], [0.5], [0.8, 0.2]]}}]\n", {"s.yaml:2:41: ", "two numbers"});
}

TEST(SceneErrors, SizesThatAreNoWholeCellsNameTheNearest) {
  // Truth: 1.01 m of cells of 2/64 m are 32.32; 1 m (32 cells) and 1.03125 m (33) are the neighbours.
  expectFault("domain: {size: [2, 1.01], resolution: 64}\n",
              {"s.yaml:1:16: ", "32.32 cells", "[2, 1] or [2, 1.03125]"});
  // The least is four cells, of 2/64 m.
  expectFault("domain: {size: [2, 0.01], resolution: 64}\n", {"s.yaml:1:16: ", "[2, 0.125] or [2, 0.15625]"});
  expectFault("domain: {size: [2e300, 1e300], resolution: 64}\n",
              {"s.yaml:1:16: ", "between 1e-9 and 1e9 m"});
  expectFault("domain: {size: [2e-300, 1e-300], resolution: 64}\n",
              {"s.yaml:1:16: ", "between 1e-9 and 1e9 m"});
}

TEST(SceneErrors, MemoryThatCannotBeHadIsNamed) {
  // Truth: 10^6 x 5 10^5 cells at 200 bytes are 100 TB. Nothing is allocated: the test would not survive it.
  expectFault("domain: {size: [2, 1], resolution: 1000000}\n",
              {"s.yaml:1:36: ", "100000 GB", "this machine has"});
}

TEST(SceneErrors, FramesAndDurationsAreWholeSteps) {
  // Truth: 1/30 s is 3.33 steps of 0.01 s, and 1/90 is the nearest step that gives 3; 1.0025 s are 120.3
  // steps of 1/120.
  expectFault(kDomain + "time: {step: 0.01}\n", {"s.yaml:2:14: ", "3.33333 steps", "1/90 s, 3 a frame"});
  expectFault(kDomain + "time: {step: 0.1}\n", {"s.yaml:2:14: ", "1/30 s, 1 a frame"});
  expectFault(kDomain + "time: {step: 1/120, duration: 1.0025}\n",
              {"s.yaml:2:31: ", "120.3 steps", "1 or 1.00833"});
  expectFault(kDomain + "time: {step: 0}\n", {"s.yaml:2:14: ", "larger than 0"});
}

TEST(SceneErrors, WallsThatCannotBe) {
  // Truth: what flows in must get out; opposite sides are periodic together; a wall slides along itself.
  expectFault(kDomain + "walls: {left: {inflow: [1, 0]}}\n",
              {"s.yaml:2:9: ", "inflow without a way out", "flow in"});
  expectFault(kDomain + "walls: {left: {inflow: [-1, 0]}}\n",
              {"s.yaml:2:9: ", "without a way out", "flow out"});
  expectFault(kDomain + "walls: {left: {inflow: [\"sin(t)\", 0]}}\n", {"s.yaml:2:9: ", "without a way out"});
  expectFault(kDomain + "walls: {left: {inflow: [1, 0]}, right: {inflow: [\"5.99*y*(1-y)\", 0]}}\n",
              {"s.yaml:2:9: ", "without a way out", "flow in"});
  EXPECT_EQ(problemsOf(kDomain + "walls: {left: {inflow: [1, 0]}, right: {inflow: [\"6*y*(1-y)\", 0]}}\n"),
            "");
  expectFault(kDomain + "walls: {left: inflow}\n", {"s.yaml:2:15: ", "needs a velocity"});
  expectFault(kDomain + "walls: {left: periodic}\n",
              {"s.yaml:2:9: ", "its opposite", "walls.right: periodic"});
  expectFault(kDomain + "walls: {top: {no-slip: [0, 1]}}\n", {"s.yaml:2:24: ", "slide along itself"});
  EXPECT_EQ(problemsOf(kDomain + "walls: {left: {inflow: [1, 0]}, right: {inflow: [1, 0]}}\n"), "");
  EXPECT_EQ(problemsOf(kDomain + "walls: {left: {inflow: [\"y-0.5\", 0]}}\n"), "");
  EXPECT_EQ(problemsOf(kDomain + "walls: {left: {inflow: [1, 0]}, top: open}\n"), "");
  EXPECT_EQ(problemsOf(kDomain + "walls: {left: periodic, right: periodic, top: {no-slip: [1, 0]}}\n"), "");
}

TEST(SceneErrors, MotionsThatCannotBe) {
  // Truth: one kind of script a solid, keys in the order of time.
  const std::string head = kDomain + "solids: [{shape: {circle: {radius: .1}}, position: [1, .5], motion: ";
  expectFault(head + "{spin: 1, expression: {x: t}}}]\n", {"s.yaml:2:69: ", "must be one of"});
  expectFault(head + "{keyframes: [{at: 1}, {at: 1}]}}]\n", {"s.yaml:2:96: ", "order of their times"});
  expectFault(head + "{keyframes: [{position: [1, 1]}]}}]\n",
              {"s.yaml:2:82: ", "keyframes.0.at` is missing"});
  expectFault(head + "{keyframes: []}}]\n", {"has no keyframes"});
  expectFault(head + "{spin: 1, smooth: true}}]\n", {"`smooth` goes with keyframes"});
  expectFault(head + "{keyframes: [{at: 0}], repeat: true}}]\n", {"at least two keyframes"});
}

TEST(SceneErrors, EventsThatCannotBe) {
  // Truth: one time and one action each, on things that exist and that may change.
  const std::string head = kDomain + "fluid: {}\nevents:\n- ";
  expectFault(head + "{set: {fluid.vorticity: 1}}\n", {"s.yaml:4:3: ", "has no time"});
  expectFault(head + "{at: 1, every: 1, caption: a}\n", {"s.yaml:4:11: ", "`at` and `every` at once"});
  expectFault(head + "{at: 1}\n", {"s.yaml:4:3: ", "does nothing", "one of set, burst"});
  expectFault(head + "{at: 1, until: 2, caption: a}\n", {"s.yaml:4:11: ", "`until` goes with `every`"});
  expectFault(head + "{at: -1, caption: a}\n", {"s.yaml:4:8: ", "0 or larger"});
  expectFault(head + "{every: 0, caption: a}\n", {"s.yaml:4:11: ", "larger than 0"});
  expectFault(head + "{every: 1e-9, caption: a}\n", {"s.yaml:4:11: ", "a thousandth of a frame"});
  expectFault(head + "{at: 1, set: {fluid.density: 2}, caption: a}\n", {"s.yaml:4:36: a second action"});
  expectFault(head + "{at: 1, stop: car}\n", {"s.yaml:4:17: ", "no solid is named `car`"});
  expectFault(head + "{at: 1, force: {circle: {radius: 1}}}\n",
              {"s.yaml:4:18: ", "acceleration` is missing"});
  expectFault(head + "{at: 1, set: {fluid.vortcity: 1}}\n",
              {"s.yaml:4:17: ", "setting `fluid.vortcity`", "unknown key `vortcity`", "`vorticity`"});
  expectFault(head + "{at: 1, set: {fluid.viscosity: -1}}\n", {"s.yaml:4:17: ", "0 or larger"});
  expectFault(head + "{at: 1, set: {smoke.sources.0.rate: 1}}\n",
              {"s.yaml:4:17: ", "no list `smoke.sources`"});
  expectFault(head + "{at: 1, set: {solids.fan.drag: 1}}\n", {"s.yaml:4:17: "});
  for (const char* fixed :
       {"domain.resolution: 8", "time.step: 1/60", "output.fps: 60", "method.tolerance: 1e-3", "title: b",
        "events: []", "solids: []", "solids.a.shape: {}"})
    expectFault(head + "{at: 1, set: {" + fixed + "}}\n", {"s.yaml:4:17: ", "cannot change during a run"});
  expectFault(head + "{at: 1, set: {walls.left: open}}\n", {"s.yaml:4:17: ", "kind of a wall cannot change"});
  expectFault(kDomain + "events:\n- {at: 1, set: {fluid.vorticity: 1}}\n", {"s.yaml:3:17: ", "no fluid"});
  expectFault(kDomain + "events:\n- {at: 1, burst: {circle: {radius: 1}}}\n",
              {"s.yaml:3:18: ", "needs a fluid"});
}

TEST(SceneErrors, OnlySolidsAndListedLayersCanBeShown) {
  // Truth: a name that nothing has suggests the nearest solid or layer; a layer that the view does not list
  // is told so; a name that both have is a warning.
  const std::string head = kDomain +
                           "solids: [{name: gate, shape: {circle: {radius: .1}}, position: [1, .5]}]\n"
                           "view: {layers: [smoke, {pressure: {shown: false}}]}\nfluid: {}\nevents:\n- ";
  EXPECT_EQ(problemsOf(head + "{at: 1, show: [gate, pressure]}\n"), "");
  expectFault(head + "{at: 1, hide: car}\n",
              {"s.yaml:6:17: ", "no solid, body or layer is named `car`", "known: gate, smoke, pressure"});
  expectFault(head + "{at: 1, show: presure}\n", {"s.yaml:6:17: ", "did you mean `pressure`?"});
  expectFault(head + "{at: 1, show: [pressure, gat]}\n", {"s.yaml:6:28: ", "did you mean `gate`?"});
  expectFault(head + "{at: 1, show: vorticity}\n",
              {"s.yaml:6:17: the view has no layer `vorticity`", "{vorticity: {shown: false}}"});
  expectFault(head + "{at: 1, show: {pressure: 1}}\n", {"s.yaml:6:17: ", "must be a text"});
  expectFault(head + "{at: 1, stop: pressure}\n", {"s.yaml:6:17: ", "no solid is named `pressure`"});
  expectFault(head + "{at: 1, set: {view.layers.presure.opacity: 1}}\n",
              {"s.yaml:6:17: ", "did you mean `pressure`?"});
  expectFault(kDomain + "view: {layers: [{smoke: {shown: 3}}]}\n",
              {"`view.layers.0.smoke.shown` must be true"});
  expectFault(kDomain +
                  "solids: [{name: smoke, shape: {circle: {radius: .1}}, position: [1, .5]}]\n"
                  "events: [{at: 1, hide: smoke}]\n",
              {"s.yaml:3:24: warning: `smoke` is a solid and a layer", "view.layers.smoke.shown"});
}

TEST(SceneErrors, EmptyItemsOfListsAreNamed) {
  // Truth: an event or a probe without any key says nothing at all, whether written as {} or left out.
  for (const char* item : {"{}", "~"}) {
    EXPECT_NE(problemsOf(kDomain + "events: [" + item + "]\n").find("`events.0` does nothing"),
              std::string::npos);
    expectFault(kDomain + "probes: [" + item + "]\n", {"must have either `at` or `region`"});
  }
}

TEST(SceneErrors, ProbesAndCamerasFollowWhatIsThere) {
  // Truth: a name that no solid has, a probe without or with two places.
  const std::string head =
      kDomain + "solids: [{name: gate, shape: {circle: {radius: .1}}, position: [1, .5]}]\n";
  expectFault(head + "probes: [{at: [1, .5], follow: gat}]\n", {"s.yaml:3:32: ", "did you mean `gate`?"});
  expectFault(head + "probes: [{name: p}]\n", {"s.yaml:3:10: ", "either `at` or `region`"});
  expectFault(head + "view: {camera: {follow: car}}\n", {"s.yaml:3:25: ", "no solid or body is named `car`"});
  EXPECT_EQ(problemsOf(head + "view: {camera: {follow: gate, height: 1}}\n"), "");
}

TEST(SceneErrors, AllAreReportedInOneRun) {
  // Truth: four faults, four messages, in the order of the file.
  const std::string problems = problemsOf(
      "domain: {size: [2, 1], resolution: 64}\nfluid: {density: -1, foo: 2}\nbodys: []\nwalls: {left: "
      "opn}\n");
  EXPECT_EQ(lines(problems), 4u) << problems;
  std::size_t last = 0;
  for (const char* place : {"s.yaml:2:18", "s.yaml:2:22", "s.yaml:3:1", "s.yaml:4:15"}) {
    const std::size_t at = problems.find(place);
    ASSERT_NE(at, std::string::npos) << place << "\n" << problems;
    EXPECT_GE(at, last);
    last = at;
  }
}

TEST(SceneErrors, EachIsOneLine) {
  // Truth: what a value has of line breaks and other control characters is shown as YAML writes it.
  const Problem problem{{"s.yaml", 3, 4}, "no colour `a\nb\x1b[1m\t`", "or\x7f", false};
  EXPECT_EQ(problem.text(), "s.yaml:3:4: no colour `a\\nb\\x1b[1m\\t` (or\\x7f)");
}

TEST(SceneErrors, WarningsDoNotStopAnything) {
  // Truth: things outside of the domain and after the end are odd, but can be run.
  const std::string solid = kDomain + "solids: [{shape: {circle: {radius: .1}}, position: [5, 5]}]\n";
  expectFault(solid, {"s.yaml:2:10: warning: solid `solid 1` lies outside"});
  EXPECT_EQ(SceneDocument::parse(solid, "s.yaml").spec().solids.size(), 1u);
  expectFault(kDomain + "smoke: {sources: [{shape: {circle: {center: [-1, 0], radius: .1}}}]}\n",
              {"warning: ", "source"});
  expectFault(kDomain + "probes: [{at: [3, 3]}]\n", {"warning: probe `probe 1` lies outside"});
  expectFault(kDomain + "events: [{at: 11, caption: late}]\n", {"warning: ", "after the end"});
  expectFault(kDomain +
                  "solids: [{shape: {circle: {radius: .1}}, position: [1, .5], "
                  "motion: {keyframes: [{at: 0}, {at: 10}, {at: 12}]}}]\n",
              {"warning: ", "never reached"});
  EXPECT_EQ(problemsOf(kDomain + "solids: [{shape: {circle: {radius: .1}}, position: [-1, .5], "
                                 "motion: {velocity: [1, 0]}}]\n"),
            "");
}

}  // namespace
}  // namespace smokebox
