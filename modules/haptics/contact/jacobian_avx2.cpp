// J for processors with AVX2 and FMA, compiled with these flags and called only on these.
#if defined(__AVX2__) && defined(__FMA__)
#define PATINA_KERNEL jacobian_avx2
#include "haptics/contact/jacobian_kernel.h"
#endif
