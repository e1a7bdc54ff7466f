// Reads .vti files; errors become exceptions instead of VTK's printed messages.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <vtkImageData.h>
#include <vtkSmartPointer.h>

namespace patina {

// Reads the whole image. Throws FileError for a file that is missing, damaged, not .vti, larger
// than 2^30 nodes, nested more than 32 levels deep, or too short for its arrays; never prints.
vtkSmartPointer<vtkImageData> readVolume(const std::filesystem::path& path);

// Throws FileError if the file is missing, a folder, empty, or not a .vti.
void requireVolumeFile(const std::filesystem::path& path);

// Returns the names of the point arrays without reading values. Throws FileError.
std::vector<std::string> pointArraysOf(const std::filesystem::path& path);

} // namespace patina
