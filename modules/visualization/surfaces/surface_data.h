// Triangles as VTK draws them.
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "geometry/atlas/texture_layout.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Unit normals of each triangle's corners: smooth where neighbouring faces meet at less than
// crease_deg; zero if nothing there has area, NaN for a triangle with a corner that is not finite.
using CornerNormals = std::vector<std::array<Vec3, 3>>;
CornerNormals smoothNormals(const TriangleMesh& mesh, double crease_deg = 40);

// With point normals, points split where those of their corners differ. Triangles with a corner
// that is not finite are left out.
vtkSmartPointer<vtkPolyData> surfaceData(const TriangleMesh& mesh, double crease_deg = 40);

// The same with texture coordinates (one entry a triangle); points are split where these differ,
// too.
vtkSmartPointer<vtkPolyData> texturedData(const TriangleMesh& mesh, const CornerUvs& uvs);

// With given normals, of any length, and the vertex of the mesh that each point came from.
vtkSmartPointer<vtkPolyData> surfaceData(const TriangleMesh& mesh, const CornerNormals& normals,
                                         std::vector<std::int32_t>& vertex_of_point);

// Points and triangles as they are, without normals: for files.
vtkSmartPointer<vtkPolyData> plainData(const TriangleMesh& mesh);

} // namespace patina
