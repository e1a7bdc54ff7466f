// Marker rigs that people print and glue onto a pen, and the sheets to print (A04).
#pragma once

#include <vector>

#include "acquisition/calibration/board.h"
#include "acquisition/loaded/printer.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

enum class RigShape {
  cube,        // 5 markers
  pen,         // a hexagonal prism, 13 markers in two rows and on its end
  dodecahedron // 11 markers
};

struct RigPlan {
  RigShape shape = RigShape::cube;
  double size = 0.036; // side of a marker with its white margin, one bit wide [m]
  double bore = 0.01;  // diameter of the pen that is pushed into the holder [m]
  double tip = 0.12;   // distance of the pen's tip from the body's middle [m]
  std::string family = "4x4_50";
};

// The body stands about the origin of the probe's frame; the pen leaves it towards -z, where there
// is no marker.
struct PrintedRig {
  struct Face {
    Pose probe_from_face = Pose::Identity(); // z points outward
    std::vector<Vec2> outline;               // convex, in the face's frame, anticlockwise [m]
    std::vector<std::size_t> markers;
  };
  std::vector<RigMarker> markers;
  std::vector<Face> faces; // those with markers
  Vec3 tip = Vec3::Zero(); // in the probe's frame [m]
  TriangleMesh holder;     // closed: the body with a tube below it, and a bore in both
};

// Throws Error if the family is not known or has too few markers, or the bore does not fit.
PrintedRig printedRig(const RigPlan& plan);

// Returns A4 pages with the faces to be cut out, a ruler and a square to be measured. Throws Error
// if a face does not fit onto one.
std::vector<PrintedPage> sheetsOf(const PrintedRig& rig);
// Returns an A4 page with a ChArUco board. Throws Error if it does not fit.
PrintedPage sheetOf(const Board& board);

} // namespace patina
