// Fields and volumes as .vti (VTK XML ImageData), for ParaView and back.
#pragma once

#include <filesystem>

#include "field/surface_field.h"
#include "geometry/triangle_mesh.h"

namespace patina {

// Dense arrays "phi [m]" (float; beyond the band clamped to +-band) and, where there is one,
// "face" (int32, -1 beyond the band); field data "band [voxel]". Compressed, written atomically.
void writeField(const std::filesystem::path& path, const SurfaceField& field);

// A field written by writeField. Throws FileError if it is not one.
SurfaceField readField(const std::filesystem::path& path);
bool isField(const std::filesystem::path& path); // false for a volume from elsewhere

// Any scalar volume from elsewhere: its iso-surface as a mesh in the file's own unit, to be felt.
TriangleMesh isoSurfaceOfVolume(const std::filesystem::path& path, double iso);
struct VolumeRange {
  double low = 0, high = 0;
};
VolumeRange scalarRange(const std::filesystem::path& path);

} // namespace patina
