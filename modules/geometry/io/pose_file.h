// A pose as a person writes it: 4 x 4 numbers in a text file.
#pragma once

#include <filesystem>
#include <string>

#include "core/types.h"

namespace patina {

// Row by row, '#' starts a comment. Throws FileError naming the line: a word that is no finite
// number, too few or too many, a last row other than 0 0 0 1, not a rotation.
Pose readPose(const std::filesystem::path& path);
Pose parsePose(const std::string& text, const std::string& name);
// The same to be written; `frames` is the comment, "mesh_from_scan".
std::string poseText(const Pose& pose, const std::string& frames);

// The 4 x 4 numbers that an object in a JSON file has under this key: "mesh_from_scan" of a
// registration, "mesh_from_camera" of a truth. Throws FileError.
Pose readPoseAt(const std::filesystem::path& path, const std::string& key);

} // namespace patina
