// The look for processors with AVX2 and FMA; compiled with those flags, entered only after asking
// the processor.
#if defined(__AVX2__) && defined(__FMA__)
#define PATINA_KERNEL texture_avx2
#include "scene/paint/texture_kernel.h"
#endif
