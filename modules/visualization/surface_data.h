// Triangles as VTK draws them.
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "geometry/triangle_mesh.h"

namespace patina {

// With point normals: smooth where neighbouring faces meet at less than crease_deg, split there
// otherwise. Triangles with a corner that is not finite are left out.
vtkSmartPointer<vtkPolyData> surfaceData(const TriangleMesh& mesh, double crease_deg = 40);

// Points and triangles as they are, without normals: for files.
vtkSmartPointer<vtkPolyData> plainData(const TriangleMesh& mesh);

} // namespace patina
