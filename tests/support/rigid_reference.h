// The rows of tests/data/rigid_contacts.csv, and how far a run is off them.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
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

/// Error of `got` against the row, relative unless it is 0: at most `share` of the row's tolerance. Prints
/// all three.
inline void expectRow(const std::string& id, const std::string& name, double got, double share = 0.1) {
  const RigidReference row = rigidReference(id, name);
  const double error = std::fabs(got - row.value) / (row.value != 0 ? std::fabs(row.value) : 1);
  std::printf("%-4s %-44s %.1e of %.0e (%.2g of a tenth)\n", id.c_str(), name.c_str(), error, row.tolerance,
              10 * error / row.tolerance);
  EXPECT_LE(error, share * row.tolerance) << id << ", " << name;
}

}  // namespace smokebox::test
