// Reading .vti without VTK's habit of printing an error and going on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <vtkImageData.h>
#include <vtkSmartPointer.h>

namespace patina {

// The whole image. Throws FileError for a file that is missing, damaged, not .vti or larger than
// 2^30 nodes; never prints.
vtkSmartPointer<vtkImageData> readVolume(const std::filesystem::path& path);

// FileError: missing, a folder, empty, or not the beginning of a .vti.
void requireVolumeFile(const std::filesystem::path& path);

// The names of its point arrays, without their values. Throws FileError.
std::vector<std::string> pointArraysOf(const std::filesystem::path& path);

} // namespace patina
