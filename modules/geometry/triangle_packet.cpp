// The kernel for any processor, and the choice at run time.
#define PATINA_KERNEL packet_plain
#include "geometry/triangle_packet_kernel.h"

namespace patina {

#if defined(__x86_64__)
namespace packet_avx2 {
void lattice(const LatticeJob& job);
}
#endif

void closestOnLattice(const LatticeJob& job) {
#if defined(__x86_64__)
  static const bool wide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (wide) return packet_avx2::lattice(job);
#endif
  packet_plain::lattice(job);
}

void closestOnLatticePlain(const LatticeJob& job) {
  packet_plain::lattice(job);
}

} // namespace patina
