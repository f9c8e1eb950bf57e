// The rows of tests/data/rigid_contacts.csv.
#pragma once
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace smokebox::test {

struct RigidReference {
  double value = 0, tolerance = 0;
};

/// The row of that id and case; throws if there is none.
inline RigidReference rigidReference(const std::string& id, const std::string& name) {
  std::ifstream file(std::string(SMOKEBOX_SOURCE_DIR) + "/tests/data/rigid_contacts.csv");
  for (std::string line; std::getline(file, line);) {
    std::istringstream row(line);
    std::string cells[5];
    for (std::string& cell : cells) std::getline(row, cell, ',');
    if (cells[0] == id && cells[1] == name) return {std::stod(cells[3]), std::stod(cells[4])};
  }
  throw std::runtime_error("no row " + id + ", " + name);
}

}  // namespace smokebox::test
