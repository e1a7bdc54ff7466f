// Writes VTK's XML files atomically and quickly. All functions throw FileError.
#pragma once

#include <filesystem>

#include <vtkImageData.h>
#include <vtkPolyData.h>

namespace patina {

void writePolyData(const std::filesystem::path& path, vtkPolyData* data);    // .vtp
void writeImageData(const std::filesystem::path& path, vtkImageData* image); // .vti

} // namespace patina
