// Converts triangle meshes to VTK data.
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "geometry/atlas/texture_layout.h"
#include "geometry/mesh/triangle_mesh.h"

namespace patina {

// Unit normals of each triangle's corners: smooth across edges below crease_deg; zero if no face
// there has area, NaN for a triangle with a corner that is not finite.
using CornerNormals = std::vector<std::array<Vec3, 3>>;
CornerNormals smoothNormals(const TriangleMesh& mesh, double crease_deg = 40);

// Adds point normals; vertices are split into points if their corners' normals differ. Triangles
// with a corner that is not finite are left out.
vtkSmartPointer<vtkPolyData> surfaceData(const TriangleMesh& mesh, double crease_deg = 40);

// The same with texture coordinates (one entry per triangle), which also split points.
vtkSmartPointer<vtkPolyData> texturedData(const TriangleMesh& mesh, const CornerUvs& uvs);

// Uses given normals of any length; also returns the mesh vertex of each point.
vtkSmartPointer<vtkPolyData> surfaceData(const TriangleMesh& mesh, const CornerNormals& normals,
                                         std::vector<std::int32_t>& vertex_of_point);

// A simplified mesh, with at most `cells` vertices along its longest side. Linear time.
vtkSmartPointer<vtkPolyData> coarseData(const TriangleMesh& mesh, int cells);

// Points and triangles unchanged, without normals: for files.
vtkSmartPointer<vtkPolyData> plainData(const TriangleMesh& mesh);

} // namespace patina
