// Reads and writes fields and volumes as .vti (VTK XML ImageData), for ParaView.
#pragma once

#include <filesystem>

#include "field/store/surface_field.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Writes point arrays "phi [m]" (float, clamped to +-band), "phi rounding [ulp]" (int8: rounding
// error of phi [m] against the stored voxels, 127 beyond the band, so that stored nodes read back
// bit for bit) and, if present, "face" (int32, -1 beyond the band); field data "grid [m]" (origin,
// voxel), "band [voxel]" and, if present, "coarse [voxel]". The file has compressed pieces of 64
// nodes a side; pieces without a stored node are in it once. Memory is close to the field's own.
// Written atomically. Throws FileError.
void writeField(const std::filesystem::path& path, const SurfaceField& field);

// Reads a file of writeField, also after VTK or ParaView has saved it. Grid, distance, face and
// coarse layers are restored; the sample layer is computed (withSamples). Throws FileError if the
// file is damaged, holds no field, or its Origin or Spacing was changed.
SurfaceField readField(const std::filesystem::path& path);
bool isField(const std::filesystem::path& path); // false for a volume from another program

// Returns the iso-surface of a scalar volume as a mesh in the file's unit. If closed, its normals
// point outward, whichever side of the iso-value is solid. Throws FileError; names the range of
// values if there is no surface at `iso`.
TriangleMesh isoSurfaceOfVolume(const std::filesystem::path& path, double iso);
struct VolumeRange {
  double low = 0, high = 0;
};
VolumeRange scalarRange(const std::filesystem::path& path);

} // namespace patina
