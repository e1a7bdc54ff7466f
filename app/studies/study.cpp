#include "app/studies/study.h"

#include "app/studies/field_study.h"

namespace patina {

const std::vector<Study>& studies() {
  static const std::vector<Study> all = {
      {"field", "samplers and storage of the field on sphere, torus and box", fieldStudy},
  };
  return all;
}

} // namespace patina
