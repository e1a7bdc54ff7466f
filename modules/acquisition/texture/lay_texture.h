// A path's strokes lay a texture onto the mesh that they run over (A12 to A16).
#pragma once

#include "acquisition/texture/texture_coordinates.h"
#include "core/progress.h"

namespace patina {

struct LayOptions {
  std::int32_t texture = 0;
  int rings = 2; // of neighbours that are textured too
  Neighbours neighbours = Neighbours::by_vertex;
  double most_stretch = 2;
};

struct LaidTexture {
  std::vector<TexturedFace> faces;
  std::vector<double> lengths; // of each stroke that has one [m]
  // Faces near the path that got no coordinates (PathCoordinates).
  std::size_t folded = 0, ambiguous = 0, stretched = 0;
  double most = 0, least = 0; // stretch along x of the laid faces
  double farthest = 0;        // of the path's points from the mesh [m]
};

// Each stroke is brought to the mesh's nearest points and evened over a quarter of the faces' edges
// that it crosses (median), for finer than that no face can follow it; noise would only lengthen
// it. x is what the stroke says, or begins at zero with it and runs on where a hand turns back. A
// face near several strokes, or near the legs of one that goes there and back, takes the nearest;
// of those that are alike within half of its edges the first, for legs that cover one another would
// else share it face by face. Throws Error where no stroke has a length, Cancelled.
LaidTexture layTexture(const PathGround& ground, const std::vector<PathOnMesh>& strokes,
                       const LayOptions& options, const Progress& progress);

// Both; a face that has a texture in either gets the one above.
std::vector<TexturedFace> laidOver(const std::vector<TexturedFace>& above,
                                   const std::vector<TexturedFace>& below);

// Where an even path turns back: places in it at which it goes against where it came from, over
// `reach` steps each.
std::vector<std::size_t> turnsOf(const std::vector<Vec3>& path, std::size_t reach);

// Means of the path's points over each `step` of its way [m]; both ends stay.
PathOnMesh evened(const PathOnMesh& path, double step);

} // namespace patina
