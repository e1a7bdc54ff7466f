// Kernel for AVX2 and FMA, compiled with those flags and called only if the processor has both.
#if defined(__AVX2__) && defined(__FMA__)
#define PATINA_KERNEL material_avx2
#include "scene/paint/material_kernel.h"
#endif
