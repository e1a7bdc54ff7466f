// How many methods each class of a source declares, counted on its text.
#pragma once

#include <string>
#include <vector>

namespace patina::architecture {

struct ClassSize {
  std::string name; // empty: it has none
  int line = 1;
  int methods = 0; // constructors, operators, overloads, signals and private ones: all
};

// In the order in which they are defined; one inside another counts for itself. Friends, aliases
// and data, whatever they are set to, are no methods.
std::vector<ClassSize> classesIn(const std::string& text);

} // namespace patina::architecture
