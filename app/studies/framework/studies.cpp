#include "app/studies/framework/studies.h"

namespace patina {

const std::vector<Study>& studies() {
  static const std::vector<Study> all = {
      {"field", "samplers of the field on sphere, torus and box", fieldStudy},
      {"contact", "proxy and ray against closed forms, and on any shape against the exact proxy",
       contactStudy},
      {"friction", "energy of a stroke, stick-slip, direction, by period and speed", frictionStudy},
      {"surfaces", "offset, magnetic and merged surfaces; work over closed loops", surfacesStudy},
      {"paint", "brush coverage; height and slope of baked and pulled relief", paintStudy},
      {"material", "painted stiffness: its value, and work over closed loops", materialStudy},
      {"stability", "the closed loop against eigenvalues and closed forms; stabilisers",
       stabilityStudy},
      {"device", "an emulated Falcon: counts, round trips, stability limit, stiffness displayed",
       deviceStudy},
      {"tracking", "poses of a marker rig from rendered frames; a tip by pivoting", trackingStudy},
      {"filter", "paths of a probe from camera and accelerometers; heights; stiffness",
       filterStudy},
      {"registration", "registration of a path to a mesh by several methods; convergence",
       registrationStudy},
      {"texture", "harmonics and blending of a profile; run time of each evaluation form",
       textureStudy},
      {"scan", "a scan by a rig made by hand, from its frames to the force that is felt",
       scanStudy},
  };
  return all;
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
