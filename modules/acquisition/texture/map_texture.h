// Maps a texture along a path's strokes onto the mesh (A12 to A16).
#pragma once

#include "acquisition/texture/texture_coordinates.h"
#include "core/progress.h"

namespace patina {

struct LayOptions {
  std::int32_t texture = 0;
  int rings = 2; // rings of neighbours that are textured, too
  Neighbours neighbours = Neighbours::by_vertex;
  double max_stretch = 2;
};

struct MappedTexture {
  std::vector<TexturedFace> faces;
  std::vector<double> lengths; // length of each stroke that has one [m]
  // Faces near the path without coordinates (PathCoordinates).
  std::size_t folded = 0, ambiguous = 0, stretched = 0;
  double max_stretch = 0, min_stretch = 0; // largest and least stretch along x of the mapped faces
  double max_distance = 0; // largest distance of the path's points from the mesh [m]
};

// Projects each stroke to the mesh and resamples it uniformly at a quarter of the median edge of
// the faces it crosses; finer detail is noise that only lengthens it. x is the stroke's own arc
// length, or starts at zero with it and continues where the hand reverses. A face near several
// strokes, or parts of one stroke that reverses, takes the nearest; among those that differ by less
// than half of its edges, the first, so that overlapping strokes do not alternate between faces.
// Throws Error if no stroke has a length, Cancelled.
MappedTexture mapTexture(const MeshQuery& ground, const std::vector<PathOnMesh>& strokes,
                         const LayOptions& options, const Progress& progress);

// Merges two mappings; a face in both gets the one above.
std::vector<TexturedFace> laidOver(const std::vector<TexturedFace>& above,
                                   const std::vector<TexturedFace>& below);

// Returns the indices at which a uniform path reverses, by directions over `reach` steps.
std::vector<std::size_t> reversalsOf(const std::vector<Vec3>& path, std::size_t reach);

// Resamples the path uniformly: means over each `step` of arc length [m]; both ends stay.
PathOnMesh resampledUniformly(const PathOnMesh& path, double step);

} // namespace patina
