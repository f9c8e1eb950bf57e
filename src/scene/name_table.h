// Where the things of a scene stand in its lists, by their names: one of ten thousand is found as quickly as
// one of three.
#pragma once
#include <string>
#include <unordered_map>

namespace smokebox {

struct Named {
  enum class Of { solid, body, cloth };
  Of of = Of::solid;
  int first = -1;  // in SceneSpec::solids, bodies or cloths
  int count = 1;   // copies of a body that repeats stand side by side
  // It is wrong in itself, which has been reported; whatever is said of its parts (copies, particles) is not.
  bool isWrong = false;
};

class NameTable {
 public:
  /// Who has the name already keeps it; `number` next to it is one more copy.
  void add(const std::string& name, Named::Of of, int number) {
    const auto [at, isNew] = table_.try_emplace(name, Named{of, number, 1});
    Named& named = at->second;
    if (!isNew && named.of == of && named.first + named.count == number) ++named.count;
  }
  void markWrong(const std::string& name) { table_.at(name).isWrong = true; }
  /// Is `name` a copy or particle of something that is wrong?
  bool isPartOfWrong(const std::string& name) const {
    const Named* whole = find(name.substr(0, name.find('.')));
    return whole && whole->isWrong;
  }
  const Named* find(const std::string& name) const {
    const auto at = table_.find(name);
    return at == table_.end() ? nullptr : &at->second;
  }

 private:
  std::unordered_map<std::string, Named> table_;
};

}  // namespace smokebox
