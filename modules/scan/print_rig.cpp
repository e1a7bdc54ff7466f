#include "scan/print_rig.h"

#include "acquisition/files/scan_tables.h"
#include "core/error.h"
#include "core/file.h"
#include "core/output_target.h"
#include "core/staged_folder.h"
#include "geometry/io/mesh_io.h"

namespace patina {
namespace {

void requireDrawn(const std::string& cause) {
  if (!cause.empty()) throw Error("the sheets cannot be drawn: " + cause);
}

// Printing again must not replace what a calibration found.
void requireNotCalibrated(const std::filesystem::path& rig) {
  if (pathExists(rig) && parseRigDeviations(readFile(rig), rig.string()).calibrated)
    throw FileError(rig.string(), 0,
                    "is calibrated, and printing would replace it by nominal places: name another "
                    "folder, or move it away");
}

} // namespace

std::string boardBeside(const std::string& family) {
  return std::string("charuco:8x5:32mm:24mm:") + (family.starts_with("5x5") ? "6x6_50" : "5x5_50");
}

PrintRigReport printRig(const RigPlan& plan, const std::filesystem::path& folder) {
  requireNotCalibrated(folder / "rig.json");
  const PrintedRig rig = printedRig(plan);
  const std::vector<PrintedPage> sheets = sheetsOf(rig);
  PrintRigReport report;
  report.markers = rig.markers.size();
  report.marker_size = rig.markers.front().size;
  report.pages = sheets.size();
  report.board = boardBeside(plan.family);
  const PrintedPage board = sheetOf(parseBoard(report.board));
  std::vector<std::pair<std::string, std::string>> files;
  const auto add = [&](const std::string& name, const auto& drawn, auto draw) {
    std::string bytes;
    requireDrawn(draw(drawn, bytes));
    files.emplace_back(name, std::move(bytes));
  };
  const PrinterLibrary& printer = printerLibrary();
  add("markers.pdf", sheets, printer.pdf);
  add("board.pdf", std::vector{board}, printer.pdf);
  for (std::size_t i = 0; i < sheets.size(); ++i)
    add("markers-" + std::to_string(i + 1) + ".svg", sheets[i], printer.svg);
  add("board.svg", board, printer.svg);
  Rig nominal;
  nominal.probe.tip = rig.tip;
  files.emplace_back("rig.json", rigText(nominal, rig.markers));

  StagedFolder staged(folder, "rig.json");
  for (const auto& [name, bytes] : files) {
    writeFileAtomically(staged.path() / name, bytes);
    report.files.push_back(name);
  }
  writeMeshIn(staged.path() / "holder.stl", rig.holder, MeshUnit::mm);
  report.files.emplace_back("holder.stl");
  staged.commit();
  return report;
}

} // namespace patina
