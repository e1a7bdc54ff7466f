// Knowledge that a registered scan gives of pose and surface, and where to scan next.
#pragma once

#include <filesystem>
#include <string>

#include "acquisition/registration/next_stroke.h"
#include "scan/register_scans.h"

namespace patina {

struct ScanAdvice {
  ScanKnowledge known;
  std::optional<ScanStroke> stroke; // absent if the goal is met
};

// Strokes continue as the scan began: their samples are as close and as exact as the median of
// those so far. Deterministic.
ScanAdvice adviceFor(const SurfaceTarget& target, const RegisteredScans& scans,
                     const ScanGoal& goal = {});

// Returns a line for people: deviations now and after the stroke.
std::string inWords(const ScanAdvice& advice);

// Writes the stroke as a table x [m],y [m],z [m] in the mesh's frame. Throws FileError.
void writeStroke(const std::filesystem::path& path, const ScanStroke& stroke);

} // namespace patina
