// The kernel for any processor, and the selection at run time.
#include "core/processor.h"

#define PATINA_KERNEL packet_plain
#include "geometry/tree/triangle_packet_kernel.h"

namespace patina {

#if defined(__x86_64__)
namespace packet_avx2 {
void lattice(const LatticeJob& job);
void pointCandidates(PointJob& job);
} // namespace packet_avx2
#endif

namespace {

bool hasWideLanes() {
#if defined(__x86_64__)
  static const bool wide = hasAvx2();
  return wide;
#else
  return false;
#endif
}

} // namespace

void closestOnLattice(const LatticeJob& job) {
#if defined(__x86_64__)
  if (hasWideLanes()) return packet_avx2::lattice(job);
#endif
  packet_plain::lattice(job);
}

void trianglesNear(PointJob& job) {
#if defined(__x86_64__)
  if (hasWideLanes()) return packet_avx2::pointCandidates(job);
#endif
  packet_plain::pointCandidates(job);
}

} // namespace patina
