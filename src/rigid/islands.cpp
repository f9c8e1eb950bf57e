#include "rigid/islands.h"

#include <algorithm>

namespace smokebox {

std::vector<std::vector<int>> islandsOf(const std::vector<std::array<int, 2>>& ends, const Bodies& bodies) {
  std::vector<int> parent(bodies.count());
  for (int k = 0; k < bodies.count(); ++k) parent[k] = k;
  auto root = [&](int k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  auto moves = [&](int body) { return body >= 0 && bodies.moves(body); };
  for (const auto& [a, b] : ends)
    if (moves(a) && moves(b)) {
      const int i = root(a), j = root(b);
      parent[std::max(i, j)] = std::min(i, j);
    }
  std::vector<std::vector<int>> islands;
  std::vector<int> islandOf(bodies.count(), -1);
  for (int link = 0; link < static_cast<int>(ends.size()); ++link) {
    const auto& [a, b] = ends[link];
    if (!moves(a) && !moves(b)) continue;
    int& island = islandOf[root(moves(a) ? a : b)];
    if (island < 0) {
      island = static_cast<int>(islands.size());
      islands.emplace_back();
    }
    islands[island].push_back(link);
  }
  return islands;
}

std::vector<SharedBody> sharedBodies(const std::vector<std::array<int, 2>>& ends, const Bodies& bodies) {
  std::vector<std::array<int, 2>> linksAt;  // body, link
  for (int link = 0; link < static_cast<int>(ends.size()); ++link)
    for (const int body : ends[link])
      if (body >= 0 && bodies.moves(body)) linksAt.push_back({body, link});
  std::sort(linksAt.begin(), linksAt.end());
  linksAt.erase(std::unique(linksAt.begin(), linksAt.end()), linksAt.end());
  std::vector<SharedBody> shared;
  for (std::size_t i = 0; i < linksAt.size(); ++i)
    for (std::size_t j = i + 1; j < linksAt.size() && linksAt[j][0] == linksAt[i][0]; ++j)
      shared.push_back({linksAt[i][1], linksAt[j][1], linksAt[i][0]});
  return shared;
}

}  // namespace smokebox
