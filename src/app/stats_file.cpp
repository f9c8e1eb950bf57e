#include "app/stats_file.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "app/command_line.h"
#include "base/part_file.h"

namespace smokebox {

using Json = nlohmann::ordered_json;  // NaN and infinity come out as null

namespace {

Json pair(Vec2 v) { return Json::array({v.x, v.y}); }

Json stepRecord(const StepFigures& f) {
  Json ms = Json::object();
  for (const auto& [stage, value] : f.stageMs) ms[stage] = value;
  ms["total"] = f.totalMs;
  Json bodies = Json::array(), probes = Json::array();
  for (const BodyFigures& b : f.bodies)
    bodies.push_back({{"name", b.name},
                      {"position", pair(b.position)},
                      {"angle", b.angleDegrees},
                      {"velocity", pair(b.velocity)},
                      {"spin", b.spinDegrees},
                      {"force", pair(b.force)},
                      {"torque", b.torque}});
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
      {"bodies", std::move(bodies)},
      {"probes", std::move(probes)}};
}

}  // namespace

struct StatsFile::Records {
  Json steps = Json::array();
};

StatsFile::StatsFile(const std::string& file) : file_(file), records_(std::make_unique<Records>()) {
  const PartFile probe(file);
}

StatsFile::~StatsFile() = default;

void StatsFile::add(const StepFigures& figures) { records_->steps.push_back(stepRecord(figures)); }

void StatsFile::write(const std::string& scene, const SummaryFigures& s,
                      std::optional<double> filmFps) const {
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
  std::string text = "{\"steps\": [";
  const auto dump = [](const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
  };
  for (std::size_t k = 0; k < records_->steps.size(); ++k)  // one record a line: easy to read and to compare
    text += (k ? ",\n" : "\n") + dump(records_->steps[k]);
  text += "],\n\"summary\": " + dump(summary) + "}\n";
  writeWholeFile(file_, text);
}

double peakMemoryMb() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace smokebox
