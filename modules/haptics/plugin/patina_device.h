// Plug-in interface for force devices that only their maker's library can drive. Build a shared
// library patina_device_NAME.so that exports patina_device_entry(), put it into a folder listed in
// the variable PATINA_DEVICES (or beside the program), and choose the device plugin:NAME. File,
// folder and the folders above must belong to you or root and be writable by nobody else. C99.
//
// SI units, in the device's own frame. Patina calls describe from any thread; it calls open,
// exchange and close of a device one after another from one separate thread, not the servo's. A
// slow call only increases the state's age and thereby removes the force. No function may throw.
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PATINA_DEVICE_ABI 1u
// The exported name ends with that version, which is read from the file before any code runs.
#define patina_device_entry patina_device_entry_v1

typedef struct {
  char name[64];        // name for the user
  char note[128];       // one line: description and requirements
  double max_force;     // largest rendered force [N], the limit of what is sent; 0: none
  double max_stiffness; // largest displayable stiffness [N/m]; 0: unknown
  double workspace_low[3], workspace_high[3]; // [m]; both zero: unknown
} patina_device_description;

enum { PATINA_DEVICE_OK = 0, PATINA_DEVICE_CALIBRATING = 1, PATINA_DEVICE_GONE = 2 };

// Values that exchange leaves unset make the reply invalid, except the last five (default 0).
typedef struct {
  double position[3];    // [m]
  double orientation[4]; // handle's unit quaternion w x y z; default 1 0 0 0
  double velocity[3];    // [m/s], if has_velocity
  uint32_t has_velocity;
  uint32_t buttons; // bit i: button i is down
  uint32_t status;
  double age; // [s] since the position was measured
} patina_device_state;

typedef struct {
  uint32_t abi;  // PATINA_DEVICE_ABI
  uint32_t size; // sizeof(patina_device)
  // Fills the description without accessing the device; all values are zero before.
  void (*describe)(patina_device_description* description);
  // argument: text after plugin:NAME: in the scene, or "". On failure returns NULL and writes one
  // line with the remedy into `why`, at most `room` bytes.
  void* (*open)(const char* argument, char* why, size_t room);
  // Sends the force on the hand and reads the state, about a thousand times a second; dt [s] since
  // the last call. Returns 0 after a reply, another value without one.
  int (*exchange)(void* device, const double force[3], double dt, patina_device_state* state);
  // The preceding exchange, if any, sent zero force, even if the device did not reply.
  void (*close)(void* device);
} patina_device;

// The only exported symbol. The returned object must stay valid.
__attribute__((visibility("default"))) const patina_device* patina_device_entry(void);

#ifdef __cplusplus
}
#endif
