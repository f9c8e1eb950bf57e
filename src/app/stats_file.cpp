#include "app/stats_file.h"

#include <sys/resource.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

#include "app/command_line.h"
#include "base/errors.h"
#include "base/part_file.h"

namespace smokebox {

using Json = nlohmann::ordered_json;  // NaN and infinity come out as null

namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

Json pair(Vec2 v) { return Json::array({v.x, v.y}); }

std::string textOf(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// In the shortest form that reads back as the same number.
void addNumber(std::string& text, double value) {
  if (!std::isfinite(value)) {
    text += "null";
    return;
  }
  char digits[32];
  const std::string_view made(digits, std::to_chars(digits, digits + sizeof digits, value).ptr - digits);
  text += made;
  if (made.find_first_of(".e") == made.npos) text += ".0";
}

/// By hand: a tree of all bodies would take longer than the step that moved them.
void addBody(std::string& text, const BodyFigures& body) {
  auto number = [&](const char* name, double value) {
    text += name;
    addNumber(text, value);
  };
  auto vector = [&](const char* name, Vec2 v) {
    number(name, v.x);
    number(",", v.y);
    text += ']';
  };
  text += "{\"name\":" + textOf(body.name);
  vector(",\"position\":[", body.position);
  number(",\"angle\":", body.angleDegrees);
  vector(",\"velocity\":[", body.velocity);
  number(",\"spin\":", body.spinDegrees);
  vector(",\"force\":[", body.force);
  number(",\"torque\":", body.torque);
  text += '}';
}

Json stepRecord(const StepFigures& f) {
  Json ms = Json::object();
  for (const auto& [stage, value] : f.stageMs) ms[stage] = value;
  ms["total"] = f.totalMs;
  Json probes = Json::array();
  for (const ProbeFigures& p : f.probes)
    probes.push_back({{"name", p.name},
                      {"velocity", pair(p.velocity)},
                      {"pressure", p.pressure},
                      {"smoke", p.smoke},
                      {"temperature", p.temperature},
                      {"mass", p.mass}});
  return {
      {"step", f.step},
      {"time", f.time},
      {"ms", std::move(ms)},
      {"iterations", f.iterations},
      {"divergence", f.divergence},
      {"compression", f.compression},
      {"smoke",
       {{"mass", f.smoke.mass},
        {"emitted", f.smoke.emitted},
        {"left", f.smoke.left},
        {"min", f.smoke.min},
        {"max", f.smoke.max}}},
      {"momentum", pair(f.momentum)},
      {"angular_momentum", f.angularMomentum},
      {"energy", {{"fluid", f.energyFluid}, {"bodies", f.energyBodies}, {"potential", f.energyPotential}}},
      {"contacts", f.contacts},
      {"overlap", f.overlap},
      {"probes", std::move(probes)}};
}

}  // namespace

struct StatsFile::Output {
  explicit Output(const std::string& name)
      : target(name), part(name), file(std::fopen(part.path().c_str(), "wb")) {
    if (!file) fail();
  }
  void put(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size()) fail();
  }
  void close() {
    // What does not fit shows only when the buffer is flushed.
    if (std::fflush(file.get()) != 0 || std::fclose(file.release()) != 0) fail();
    part.commit();
  }
  [[noreturn]] void fail() const { throw IoError(target + ": " + std::strerror(errno)); }

  std::string target;
  PartFile part;
  std::unique_ptr<std::FILE, CloseFile> file;
  std::string line;
  long records = 0;
};

StatsFile::StatsFile(const std::string& file) : output_(std::make_unique<Output>(file)) {}

StatsFile::~StatsFile() = default;

void StatsFile::add(const StepFigures& figures) {
  std::string& line = output_->line;  // one record a line: easy to read and to compare
  line = output_->records++ == 0 ? "{\"steps\": [\n" : ",\n";
  line += textOf(stepRecord(figures));
  line.back() = ',';  // the record goes on
  line += "\"bodies\":[";
  for (const BodyFigures& body : figures.bodies) {
    addBody(line, body);
    line += ',';
  }
  if (!figures.bodies.empty()) line.pop_back();
  line += "]}";
  output_->put(line);
}

void StatsFile::finish(const std::string& scene, const SummaryFigures& s, std::optional<double> filmFps) {
  const Json summary = {{"scene", scene},
                        {"version", programVersion()},
                        {"steps", s.steps},
                        {"cells", s.cells},
                        {"threads", s.threads},
                        {"step_ms_median", s.stepMsMedian},
                        {"film_fps", filmFps ? Json(*filmFps) : Json()},
                        {"divergence_max", s.divergenceMax},
                        {"smoke_error", s.smokeError},
                        {"overlap_max", s.overlapMax},
                        {"peak_memory_mb", peakMemoryMb()},
                        {"state_hash", s.stateHash}};
  output_->put((output_->records == 0 ? "{\"steps\": [" : "") + std::string("],\n\"summary\": ") +
               textOf(summary) + "}\n");
  output_->close();
}

double peakMemoryMb() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace smokebox
