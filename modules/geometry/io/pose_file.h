// Reads and writes poses: 4 x 4 numbers as text or as rows in JSON.
#pragma once

#include <filesystem>
#include <string>

#include "core/json.h"
#include "core/types.h"

namespace patina {

// Reads row by row; '#' starts a comment. Throws FileError naming the line for a word that is not a
// finite number, a wrong count, a last row other than 0 0 0 1, or a matrix that is not a rotation.
Pose readPose(const std::filesystem::path& path);
Pose parsePose(const std::string& text, const std::string& name);
// Returns the text to write; `frames` becomes its comment, such as "mesh_from_scan".
std::string poseText(const Pose& pose, const std::string& frames);

Json poseJson(const Pose& pose); // four rows
// Returns the pose under a key of an object. Throws Error naming the key and the row, for the same
// faults as parsePose(); `rigid`: tolerance of lengths around 1.
constexpr double kRigid = 1e-6;
Pose poseIn(const Json& object, const std::string& key, double rigid = kRigid);
// The same from a file: "mesh_from_scan" of a registration, "mesh_from_camera" of a ground truth.
// Throws FileError.
Pose readPoseAt(const std::filesystem::path& path, const std::string& key);

} // namespace patina
