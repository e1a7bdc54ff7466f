// Fields and volumes as .vti (VTK XML ImageData), for ParaView and back.
#pragma once

#include <filesystem>

#include "field/store/surface_field.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Point arrays "phi [m]" (float; beyond the band clamped to +-band), "phi rounding [ulp]"
// (int8: what float metres lost of the stored voxels, 127 beyond the band, so that stored nodes
// read back bit for bit) and, where there is one, "face" (int32, -1 beyond the band). Field data:
// "grid [m]" (origin, voxel), "band [voxel]" and, where there is one, "coarse [voxel]".
// In pieces of 64 nodes a side, compressed, in memory near the field's own; those without a stored
// node are in the file once. Written atomically. Throws FileError.
void writeField(const std::filesystem::path& path, const SurfaceField& field);

// A field written by writeField: grid, distance, face and coarse layers as they were; the sample
// layer is derived (withSamples). One that VTK or ParaView wrote anew is read too. Throws FileError
// if the file is damaged, is not such a field, or its Origin or Spacing was changed.
SurfaceField readField(const std::filesystem::path& path);
bool isField(const std::filesystem::path& path); // false for a volume from elsewhere

// Any scalar volume from elsewhere: its iso-surface as a mesh in the file's own unit, to be felt.
// Outward-facing if closed, whichever side of the iso-value is solid. Throws FileError; names the
// range of values if there is no surface at `iso`.
TriangleMesh isoSurfaceOfVolume(const std::filesystem::path& path, double iso);
struct VolumeRange {
  double low = 0, high = 0;
};
VolumeRange scalarRange(const std::filesystem::path& path);

} // namespace patina
