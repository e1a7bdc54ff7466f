#include "haptics/energy_ledger.h"

#include <algorithm>

namespace patina {

void EnergyLedger::add(const Vec3& force, const Vec3& moved, double damping,
                       double seconds) noexcept {
  const double work = force.dot(moved);
  absorbed -= work;
  credited -= work;
  if (seconds > 0) credited += damping * moved.squaredNorm() / seconds;
  lowest_absorbed = std::min(lowest_absorbed, absorbed);
  lowest_credited = std::min(lowest_credited, credited);
}

} // namespace patina
