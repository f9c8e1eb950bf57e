// What the names of a scene stand for, where springs, joints and events use them. Solids, bodies, particles
// and cloths share one set of names; `rain` is every copy of a body that repeats, `rain.17` one of them, and
// `sheet.3.14` the particle of a cloth in column 3 and row 14.
#pragma once
#include <optional>
#include <string>

#include "scene/reader.h"
#include "scene/spec.h"

namespace smokebox {

/// Puts a thing into the scene's list, and its name into the scene's table.
void addNamed(SceneSpec& spec, SolidSpec solid);
void addNamed(SceneSpec& spec, BodySpec body);
void addNamed(SceneSpec& spec, ClothSpec cloth);

/// Reports a name that is empty, has a dot, stands for the world or belongs to another thing.
void checkNewName(Reader& reader, const YamlNode& node, const SceneSpec& spec, const std::string& name);
/// Reports a name that no path could use.
void checkName(Reader& reader, const YamlNode& node, const std::string& name);

/// One thing to take hold of: `world`, a solid, a body, a particle, a particle of a cloth. Reports what is
/// not there, what is not there yet, and what is many.
std::optional<HoldSpec> findHold(Reader& reader, const YamlNode& node, const SceneSpec& spec,
                                 const std::string& name, bool laterToo);

/// All bodies, particles and cloths that a name stands for, or the particle of a cloth. Reports what is none.
Movables findMovables(Reader& reader, const YamlNode& node, const SceneSpec& spec, const std::string& name);

/// Reports what a probe or the camera cannot follow: all but a solid, a body or a particle.
void checkFollowed(Reader& reader, const YamlNode& node, const SceneSpec& spec, const std::string& name);

/// Is it the name of a body, a particle or a cloth?
bool isMovable(const SceneSpec& spec, const std::string& name);

/// Names of solids, bodies, particles and cloths, for suggestions.
std::vector<std::string> namesOfThings(const SceneSpec& spec, bool solidsToo);

}  // namespace smokebox
