// The first hour of a lab: from nothing to a calibrated rig and a scan, in four steps, as far as
// the files of one folder show them. `patina rig status` and the desk Scan show the same.
#pragma once

#include <array>
#include <filesystem>
#include <string>

namespace patina {

struct FirstHourStep {
  bool done = false;
  std::string figure; // "0.12 px rms, 640 x 480"; empty if not done
  std::string remedy; // the next thing to do, or how to improve what is done; may be empty
};

struct FirstHour {
  FirstHourStep print;         // rig.json and the sheets
  FirstHourStep photograph;    // camera.yml, from a board
  FirstHourStep wave;          // rig.json with the deviation of the tip
  FirstHourStep scan;          // a subfolder recorded with the calibrated rig
  std::string board;           // printed beside the rig, for parseBoard()
  std::filesystem::path waved; // newest recording with a rig that was not calibrated; empty: none
  std::string command;         // the next one to be given; empty if all is done
};

// Reads what is there; a folder that does not exist shows no step done. A file that cannot be read
// leaves its step open and is named in the remedy.
FirstHour readFirstHour(const std::filesystem::path& folder);

// Returns folder/name, or folder/name-2 and so on, which does not exist.
std::filesystem::path freshPath(const std::filesystem::path& folder, const std::string& name);

} // namespace patina
