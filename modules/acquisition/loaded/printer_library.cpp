#include "acquisition/loaded/printer.h"

#include "core/error.h"
#include "core/loaded_library.h"
#include "core/memory_left.h"

namespace patina {

const PrinterLibrary& printerLibrary() {
  static std::string printer_cause;
  static void* const printer_symbol = [] {
    requireRoomToLoad("the library of the printed sheets");
    return loadedSymbol("patina_printer.so", kPrinterLibrarySymbol, printer_cause);
  }();
  if (!printer_symbol)
    throw Error("sheets need Patina's library of printing, which cannot be loaded: " +
                printer_cause);
  return *reinterpret_cast<PrinterLibraryFunction*>(printer_symbol)();
}

} // namespace patina
