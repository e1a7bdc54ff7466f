#include "scan/scan_advice.h"

#include <cmath>

#include "core/csv.h"
#include "core/numbers.h"

namespace patina {

ScanAdvice adviceFor(const SurfaceTarget& target, const RegisteredScans& scans,
                     const ScanGoal& goal) {
  const Registration& found = scans.registration;
  const double height = scans.noise > 0 ? scans.noise : found.noise;
  const std::vector<SurfaceMeasurement> measurements = measurementsOf(found, height);
  return {knowledgeOf(target, measurements, goal),
          nextStroke(target, measurements, goal, strokeOptionsFor(measurements))};
}

std::string inWords(const ScanAdvice& advice) {
  const auto state = [](double pose, double area) {
    return "pose to " + formatLength(pose) + ", heights over " +
           formatNumber(std::round(1000 * area) / 10) + " % of the area";
  };
  std::string words = state(advice.known.pose, advice.known.area);
  if (advice.known.complete) return words + ": the goal is met";
  if (!advice.stroke) return words + "; no stroke helps";
  return words + "; after the stroke " + state(advice.stroke->pose, advice.stroke->area);
}

void writeStroke(const std::filesystem::path& path, const ScanStroke& stroke) {
  CsvWriter writer(path, {"x [m]", "y [m]", "z [m]"});
  for (const Vec3& p : stroke.points) writer.add({p.x(), p.y(), p.z()});
  writer.commit();
}

} // namespace patina
