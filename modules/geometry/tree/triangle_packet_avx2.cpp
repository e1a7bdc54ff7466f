// The kernel for processors with AVX2 and FMA; compiled with those flags, entered only after
// asking the processor.
#if defined(__AVX2__) && defined(__FMA__)
#define PATINA_KERNEL packet_avx2
#include "geometry/tree/triangle_packet_kernel.h"
#endif
