// The sections of a scene file, each read into its part of the spec. Order matters where a section refers to
// another: readScene() is the one place that knows it.
#pragma once
#include <string>
#include <vector>

#include "scene/reader.h"
#include "scene/spec.h"

namespace smokebox {

/// Reads and checks a whole tree. Without `events` it is a trial of a value that an event sets: no events, no
/// warnings.
SceneSpec readScene(const YamlPtr& root, const std::string& name, std::vector<Problem>& problems,
                    bool events = true);

void readDomain(MapReader& scene, SceneSpec& spec);
void readWalls(MapReader& scene, SceneSpec& spec);
void readTimeAndOutput(MapReader& scene, SceneSpec& spec);
void readFluid(MapReader& scene, SceneSpec& spec);
void readSmoke(MapReader& scene, SceneSpec& spec);
void readTemperature(MapReader& scene, SceneSpec& spec);
void readSolids(MapReader& scene, SceneSpec& spec);
/// bodies and particles
void readBodies(MapReader& scene, SceneSpec& spec);
void readCloths(MapReader& scene, SceneSpec& spec);
/// springs and joints
void readLinks(MapReader& scene, SceneSpec& spec);
void readProbes(MapReader& scene, SceneSpec& spec);
void readEvents(MapReader& scene, SceneSpec& spec);
void readView(MapReader& scene, SceneSpec& spec);
void readMethod(MapReader& scene, SceneSpec& spec);

/// Tries the values that events set on copies of the tree, and reports what would be wrong with them.
void checkSetActions(const YamlPtr& root, const std::string& name, SceneSpec& spec, Reader& reader);

/// Reports a fluid that is let in without a way out.
void checkInflow(MapReader& scene, const SceneSpec& spec);
/// Reports starting velocities and motions that are no finite numbers, at places and times that are tried.
void checkFormulas(MapReader& scene, const SceneSpec& spec);
/// Reports temperatures that are no finite numbers, and warns of those that do nothing.
void checkTemperature(MapReader& scene, const SceneSpec& spec, bool warnings);
/// Warns of things that lie outside of the domain.
void checkPlacement(MapReader& scene, const SceneSpec& spec);
/// Reports bodies outside of the domain; warns of those that start inside of each other, of solids or walls,
/// and of groups with a single member.
void checkBodies(MapReader& scene, const SceneSpec& spec);

/// `ignore`: a name or a list of them.
void readGroups(MapReader& map, std::vector<std::string>& groups);

/// Is it the name of a layer, whether this scene lists it or not?
bool isLayerName(const std::string& name);

/// Reports a name that no solid has.
bool checkSolidName(Reader& reader, const YamlNode& node, const SceneSpec& spec, const std::string& name);

}  // namespace smokebox
