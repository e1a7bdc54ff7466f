// Triangles as VTK draws them.
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "geometry/texture_layout.h"
#include "geometry/triangle_mesh.h"

namespace patina {

// With point normals: smooth where neighbouring faces meet at less than crease_deg, split there
// otherwise. Triangles with a corner that is not finite are left out.
vtkSmartPointer<vtkPolyData> surfaceData(const TriangleMesh& mesh, double crease_deg = 40);

// The same with texture coordinates (one entry a triangle); points are split where these differ,
// too.
vtkSmartPointer<vtkPolyData> texturedData(const TriangleMesh& mesh, const CornerUvs& uvs);

// As surfaceData(), with the vertex of the mesh that each of its points came from.
vtkSmartPointer<vtkPolyData> surfaceData(const TriangleMesh& mesh,
                                         std::vector<std::int32_t>& vertex_of_point);

// Points and triangles as they are, without normals: for files.
vtkSmartPointer<vtkPolyData> plainData(const TriangleMesh& mesh);

} // namespace patina
