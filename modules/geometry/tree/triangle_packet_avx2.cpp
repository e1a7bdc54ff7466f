// The kernel for AVX2 and FMA, compiled with those flags and called only if the processor has both.
#if defined(__AVX2__) && defined(__FMA__)
#define PATINA_KERNEL packet_avx2
#include "geometry/tree/triangle_packet_kernel.h"
#endif
