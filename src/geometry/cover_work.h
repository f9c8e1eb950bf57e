// The working memory of coverGrid: where outlines cross the grid's lines, and the pieces into which the cells
// cut them.
#pragma once
#include <vector>

#include "geometry/region_map.h"
#include "geometry/shape.h"

namespace smokebox {

/// One crossing of an outline with a grid line (of whole or half multiples of h).
struct LineCrossing {
  double position = 0;  // along the line, m
  int line = 0;         // 0..2 nx: x = line h/2; then 2 ny + 1 lines y = k h/2
  int cell = 0;         // which cell along the line; 0 on lines of odd multiples
  int solid = -1;
  int rank = 0;         // among the crossings of its line, in order of position
  bool enters = false;  // walking along the line in its positive direction: into the solid (else out of it)
};

/// What one cell holds of an outline: points [first, last], both ends on the cell's faces; solid on the left.
/// An island (no crossings): the whole of an outline that lies within the cell.
struct CellPiece {
  int cell = 0;  // j nx + i
  int first = 0, last = 0;
  int entry = -1, exit = -1;  // crossings
  int next = -1;              // further pieces of the same cell
};

/// An outline to be put onto the grid, and whose surface each of its edges is.
struct LabelledOutline {
  Outline points;
  std::vector<int> edgeSolid;
};

/// A part of a face that is shut though no solid lies there: it leads only to the lesser part of a cell.
struct ShutPart {
  bool xFace = true;
  int i = 0, j = 0;
  double lo = 0, hi = 0;                        // metres along the face's line
  int solid = -1, other = -1;                   // whose surface cuts the cell: where it begins, where it ends
  bool solidAtEnd = false, otherAtEnd = false;  // of joined sides: they lie at the other one
  double weight = 1;                            // of several that shut the same stretch
};

struct CoverWork {
  std::vector<LabelledOutline> outlines;  // grown a little, merged where solids may overlap
  int outlineCount = 0;                   // how many of them are in use; the others keep their memory
  std::vector<LineCrossing> crossings;
  std::vector<int> lineStart, lineOrder;  // crossings sorted by line and position
  std::vector<Vec2> points;
  std::vector<CellPiece> pieces;
  std::vector<int> pieceOfCell;  // first piece of each cell, -1: none
  std::vector<int> cells;        // those that hold pieces, in the order in which they were met
  std::vector<int> group;        // of each solid: solids of one group may overlap
  std::vector<double> boxes;     // of each solid: x lo, y lo, x hi, y hi

  // For one cell:
  struct End {
    int key, piece;
    int side;  // 0 bottom, 1 right, 2 top, 3 left
    double position;
    bool entry;
  };
  std::vector<End> ends;
  std::vector<int> nextEnd, part;

  // Of all cut cells, for the regions:
  struct PartArc {
    int side;       // as above
    double lo, hi;  // an opening of that face, m along its line
    int part;       // parts are numbered over all cells
  };
  std::vector<PartArc> arcs;
  std::vector<int> arcStart;  // by place in `cells`, one more at the end
  std::vector<int> keptPart;  // by place in `cells`; -1: none
  int partCount = 0;
  std::vector<ShutPart> settled;
  std::vector<double> cuts;  // of one face
  std::vector<int> sortedCells, regionRoot, regionLabel, wideRowStart;
  std::vector<RegionMap::Run> wideRuns;
};

}  // namespace smokebox
