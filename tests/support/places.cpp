// The only test source that knows its build tree: all others compile alike in every tree.
#include "support/places.h"

namespace patina::test {

std::filesystem::path sourceFolder() {
  return PATINA_SOURCE_DIR;
}

std::filesystem::path programFolder() {
  return PATINA_PROGRAM_DIR;
}

} // namespace patina::test
