#include "app/studies/framework/study.h"

namespace patina {

std::vector<WorkPrecisionTable> tablesOf(const std::vector<StudyPart>& parts, Progress& progress) {
  std::vector<WorkPrecisionTable> tables;
  for (const StudyPart& part : parts) {
    progress.throwIfCancelled();
    progress.report(part.from, part.about);
    tables.push_back(part.table());
  }
  return tables;
}

} // namespace patina
