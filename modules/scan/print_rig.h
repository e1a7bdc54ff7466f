// Files of a rig that is printed and glued: what `patina rig print` runs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "acquisition/printing/printed_rig.h"

namespace patina {

struct PrintRigReport {
  std::size_t markers = 0, pages = 0;
  double marker_size = 0;         // side of the black squares [m]
  std::string board;              // for parseBoard()
  std::vector<std::string> files; // in the folder
};

// Returns the board that is printed with markers of this family, as a text for parseBoard(). Its
// own markers are of another family, so that nothing of the board is taken for the rig.
std::string boardBeside(const std::string& family);

// Writes markers.pdf, board.pdf, the same pages as SVG, rig.json with the nominal places and
// holder.stl [mm] into `folder`, which is made: all files or none. Throws as printedRig(),
// sheetsOf() and StagedFolder do, and FileError if rig.json is there and calibrated.
PrintRigReport printRig(const RigPlan& plan, const std::filesystem::path& folder);

} // namespace patina
