#include "app/studies/study.h"

#ifdef PATINA_HAS_ACQUISITION
#include "app/studies/acquisition/filter_study.h"
#include "app/studies/acquisition/registration_study.h"
#include "app/studies/acquisition/texture_study.h"
#include "app/studies/acquisition/tracking_study.h"
#endif
#include "app/studies/field/field_study.h"
#include "app/studies/field/surfaces_study.h"
#include "app/studies/haptics/contact_study.h"
#include "app/studies/haptics/device_study.h"
#include "app/studies/haptics/friction_study.h"
#include "app/studies/haptics/stability_study.h"
#include "app/studies/paint/material_study.h"
#include "app/studies/paint/paint_study.h"

namespace patina {

const std::vector<Study>& studies() {
  static const std::vector<Study> all = {
      {"field", "samplers and storage of the field on sphere, torus and box", fieldStudy},
      {"contact", "proxy and ray against closed forms, and on any shape against the exact proxy",
       contactStudy},
      {"friction", "energy of a stroke, stick and slip, direction, by period and speed",
       frictionStudy},
      {"surfaces", "offset, magnetic and merged surfaces; work round closed loops", surfacesStudy},
      {"paint", "brush coverage; height and slope of baked and pulled relief", paintStudy},
      {"material", "painted stiffness: its value, and work round closed loops", materialStudy},
      {"stability", "the closed loop against eigenvalues and closed forms; what quietens it",
       stabilityStudy},
      {"device", "an emulated Falcon: counts, round trips, where it buzzes, stiffness displayed",
       deviceStudy},
#ifdef PATINA_HAS_ACQUISITION
      {"tracking", "poses of a marker rig from rendered frames; a tip by turning about it",
       trackingStudy},
      {"filter", "paths of a probe from camera and accelerometers; heights; stiffness",
       filterStudy},
      {"registration", "a path finds its place on a mesh, by several methods; how they converge",
       registrationStudy},
      {"texture", "harmonics and blending of a profile; what an evaluation takes, by its form",
       textureStudy},
#endif
  };
  return all;
}

std::vector<WorkPrecisionTable> tablesOf(const std::vector<StudyPart>& parts, Progress& progress) {
  std::vector<WorkPrecisionTable> tables;
  for (const StudyPart& part : parts) {
    progress.throwIfCancelled();
    progress.report(part.from, part.about);
    tables.push_back(part.table());
  }
  return tables;
}

std::vector<WorkPrecisionTable> tablesOf(const Study& study, const StudyOptions& options,
                                         Progress& progress) {
  std::vector<WorkPrecisionTable> tables = study.run(options, progress);
  progress.throwIfCancelled();
  progress.report(1, std::string(study.name) + " study");
  for (WorkPrecisionTable& table : tables) table.study = study.name;
  return tables;
}

} // namespace patina
