// Interface of the library with cairo, which is loaded at the first sheet that is printed. Both
// sides are built together, so that C++ types may be passed; exceptions may not.
#pragma once

#include <string>
#include <vector>

#include "core/types.h"

namespace patina {

// A page in true size: x to the right and y down from its top left corner [m].
struct PrintedPage {
  struct Area { // rectangles of one grey, filled together so that no seam is left between them
    double grey = 0;
    std::vector<Eigen::AlignedBox2d> parts;
  };
  struct Outline {
    std::vector<Vec2> points; // the last one is joined to the first
    double width = 0;
  };
  struct Words {
    Vec2 at = Vec2::Zero(); // left end of the base line
    double height = 0;      // height of the font
    std::string text;
  };
  Vec2 size = Vec2::Zero();
  std::vector<Area> areas;
  std::vector<Outline> outlines;
  std::vector<Words> words;
};

// Each function returns an empty text, or the cause of the failure.
struct PrinterLibrary {
  // Sets the bytes of one PDF file with all pages, or of an SVG file of one page.
  std::string (*pdf)(const std::vector<PrintedPage>&, std::string& bytes);
  std::string (*svg)(const PrintedPage&, std::string& bytes);
};

// The only symbol that is looked up.
inline constexpr const char* kPrinterLibrarySymbol = "patinaPrinterLibrary";
using PrinterLibraryFunction = const PrinterLibrary*();

// Throws Error with the missing file and the places searched.
const PrinterLibrary& printerLibrary();

} // namespace patina
