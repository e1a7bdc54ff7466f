// A pose in files: 4 x 4 numbers, as a person writes them or as rows in JSON.
#pragma once

#include <filesystem>
#include <string>

#include "core/json.h"
#include "core/types.h"

namespace patina {

// Row by row, '#' starts a comment. Throws FileError naming the line: a word that is no finite
// number, too few or too many, a last row other than 0 0 0 1, not a rotation.
Pose readPose(const std::filesystem::path& path);
Pose parsePose(const std::string& text, const std::string& name);
// The same to be written; `frames` is the comment, "mesh_from_scan".
std::string poseText(const Pose& pose, const std::string& frames);

Json poseJson(const Pose& pose); // its rows
// The rows that an object has under this key. Throws Error naming the key and the row, for all that
// parsePose() refuses; `rigid`: how far lengths may be from 1.
constexpr double kRigid = 1e-6;
Pose poseIn(const Json& object, const std::string& key, double rigid = kRigid);
// The same of a file: "mesh_from_scan" of a registration, "mesh_from_camera" of a truth. Throws
// FileError.
Pose readPoseAt(const std::filesystem::path& path, const std::string& key);

} // namespace patina
