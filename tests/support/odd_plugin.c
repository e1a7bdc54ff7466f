/* Plug-ins that are not what patina_device.h asks for, one a build: ODD says how. */
#include "haptics/plugin/patina_device.h"

#if ODD == 1 /* of a later version, and longer; it ends whoever loads it */
#undef patina_device_entry
#define patina_device_entry patina_device_entry_v2
__attribute__((visibility("default"))) const patina_device* patina_device_entry(void);
__attribute__((constructor)) static void end(void) {
  __builtin_trap();
}
static const patina_device entry = {PATINA_DEVICE_ABI + 1, sizeof(patina_device) + 8, 0, 0, 0, 0};
#else /* hollow */
static const patina_device entry = {PATINA_DEVICE_ABI, sizeof(patina_device), 0, 0, 0, 0};
#endif

const patina_device* patina_device_entry(void) {
  return ODD == 3 ? NULL : &entry;
}
