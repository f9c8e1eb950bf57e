// The flux of heat through each face: the volume that goes through it times the value there, by 5th-order
// upwind interpolation of the cells' means; third order beside walls and surfaces, the donor's value where
// not even that has its cells.
#pragma once
#include <cstdint>
#include <vector>

#include "fluid/boundary.h"
#include "fluid/heat.h"

namespace smokebox {

class HeatFlux {
 public:
  explicit HeatFlux(const Boundary& boundary);

  /// Finds the faces that need a lower order.
  void rebuild(const Boundary& boundary, const HeatSides& sides);

  // Row j of the x-faces 0 .. nx, or of the y-faces, into `flux`. `t`: three ghosts deep; `courant`: volume
  // through each face.
  void rowX(const HeatSides& sides, const Field& t, const Field& courant, int j, Field& flux) const;
  void rowY(const HeatSides& sides, const Field& t, const Field& courant, int j, Field& flux) const;

  /// The flux of the donor's value through one face.
  float donorX(const HeatSides& sides, const Field& t, const Field& courant, int i, int j) const {
    const float c = courant(i, j);
    if (!wrapX_ && i == 0 && c > 0) return c * sides.value[0][j];
    if (!wrapX_ && i == nx_ && c < 0) return c * sides.value[1][j];
    return c * (c > 0 ? t(i > 0 ? i - 1 : nx_ - 1, j) : t(i < nx_ ? i : 0, j));
  }
  float donorY(const HeatSides& sides, const Field& t, const Field& courant, int i, int j) const {
    const float c = courant(i, j);
    if (!wrapY_ && j == 0 && c > 0) return c * sides.value[2][i];
    if (!wrapY_ && j == ny_ && c < 0) return c * sides.value[3][i];
    return c * (c > 0 ? t(i, j > 0 ? j - 1 : ny_ - 1) : t(i, j < ny_ ? j : 0));
  }

  std::size_t bytes() const;

 private:
  enum Order : std::uint8_t { donor, third, fifth };
  struct LowFace {
    int i;
    Order order;
  };
  struct List {
    std::vector<LowFace> faces;
    std::vector<int> begin;  // of row j
  };

  int nx_, ny_;
  bool wrapX_, wrapY_;
  List lowX_, lowY_;
  std::vector<float> least_;  // smallest share of the y-faces in a row
};

}  // namespace smokebox
