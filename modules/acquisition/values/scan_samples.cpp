#include "acquisition/values/scan_samples.h"

namespace patina {

std::string_view nameOf(PoseVerdict verdict) {
  switch (verdict) {
  case PoseVerdict::used:
    return "used";
  case PoseVerdict::outlier:
    return "outlier";
  case PoseVerdict::not_finite:
    return "not a number";
  case PoseVerdict::repeated:
    return "repeated time";
  case PoseVerdict::backwards:
    return "time runs backwards";
  }
  return "";
}

} // namespace patina
