// Reading .vti without VTK's habit of printing an error and going on.
#pragma once

#include <filesystem>

#include <vtkImageData.h>
#include <vtkSmartPointer.h>

namespace patina {

// The whole image. Throws FileError for a file that is missing, damaged, not .vti or larger than
// 2^30 nodes; never prints.
vtkSmartPointer<vtkImageData> readVolume(const std::filesystem::path& path);

} // namespace patina
