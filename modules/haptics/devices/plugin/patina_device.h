// A force device that only its maker's library can drive, for Patina: build a shared library
// patina_device_NAME.so that exports patina_device_entry(), put it into a folder that the variable
// PATINA_DEVICES names (or beside the program), and choose the device plugin:NAME. C99.
//
// SI units, in the device's own frame. Patina calls describe from any thread, and open, exchange
// and close of a device from one thread of its own, one after another. That thread is not the
// servo's: a call that takes long shows as age and costs the force, nothing else. Nothing may be
// thrown.
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PATINA_DEVICE_ABI 1u

typedef struct {
  char name[64];        // for a person
  char note[128];       // one line: what it is, what it needs
  double max_force;     // [N], that it renders: no more is sent; 0: none at all
  double max_stiffness; // [N/m], that it can display; 0: unknown
  double workspace_low[3], workspace_high[3]; // [m]; both zero: unknown
} patina_device_description;

enum { PATINA_DEVICE_OK = 0, PATINA_DEVICE_CALIBRATING = 1, PATINA_DEVICE_GONE = 2 };

// What exchange leaves untouched is no answer but for the last five, which are zero.
typedef struct {
  double position[3];    // [m]
  double orientation[4]; // of the handle, a unit quaternion w x y z; begins as 1 0 0 0
  double velocity[3];    // [m/s], where has_velocity
  uint32_t has_velocity;
  uint32_t buttons; // bit i: button i is down
  uint32_t status;
  double age; // [s] since the position was measured
} patina_device_state;

typedef struct {
  uint32_t abi;  // PATINA_DEVICE_ABI
  uint32_t size; // sizeof(patina_device)
  // Fills in what it knows, without touching the device; all is zero before.
  void (*describe)(patina_device_description* description);
  // What stands after plugin:NAME: in the scene, or "". NULL, and why in at most `room` bytes: one
  // line that says what to do.
  void* (*open)(const char* argument, char* why, size_t room);
  // Sends the force on the hand and reads the state, about a thousand times a second; dt [s] since
  // the last time. 0: answered; anything else: no answer came this time.
  int (*exchange)(void* device, const double force[3], double dt, patina_device_state* state);
  // The exchange before it, if there was any, asked for no force, whatever the device answered.
  void (*close)(void* device);
} patina_device;

// The one symbol. What it returns stays where it is.
__attribute__((visibility("default"))) const patina_device* patina_device_entry(void);

#ifdef __cplusplus
}
#endif
