/* Plug-ins that are not what patina_device.h asks for, one a build: ODD says how. */
#include "haptics/devices/plugin/patina_device.h"

#if ODD == 1 /* of a later version, and longer */
static const patina_device entry = {PATINA_DEVICE_ABI + 1, sizeof(patina_device) + 8, 0, 0, 0, 0};
#else /* hollow */
static const patina_device entry = {PATINA_DEVICE_ABI, sizeof(patina_device), 0, 0, 0, 0};
#endif

const patina_device* patina_device_entry(void) {
  return ODD == 3 ? NULL : &entry;
}
