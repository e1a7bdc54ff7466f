// Example of a plug-in that needs no device: 100 g in a hand that holds its start position with a
// spring of 150 N/m and a damper. plugin:example:X,Y,Z sets that position in metres. Build and try:
//   cc -std=c99 -shared -fPIC -o patina_device_example.so example_device.c
//   PATINA_DEVICES=. patina devices
#include "patina_device.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  double home[3], position[3], velocity[3];
} hand;

static void describe(patina_device_description* description) {
  strcpy(description->name, "Example hand");
  strcpy(description->note, "100 g in a hand that stays where it is; no device is needed");
  description->max_force = 5;
  description->max_stiffness = 2000;
  for (int i = 0; i < 3; ++i) {
    description->workspace_low[i] = -0.1;
    description->workspace_high[i] = 0.1;
  }
}

static void* open_hand(const char* argument, char* why, size_t room) {
  hand* made = calloc(1, sizeof *made);
  if (!made) {
    snprintf(why, room, "there is no memory left");
    return NULL;
  }
  char rest;
  if (*argument && sscanf(argument, "%lf,%lf,%lf%c", &made->home[0], &made->home[1], &made->home[2],
                          &rest) != 3) {
    snprintf(why, room, "'%s' is no place: write X,Y,Z in metres", argument);
    free(made);
    return NULL;
  }
  memcpy(made->position, made->home, sizeof made->position);
  return made;
}

static int exchange(void* device, const double force[3], double dt, patina_device_state* state) {
  const double mass = 0.1, stiffness = 150, damping = 8; // [kg], [N/m], [N s/m]
  hand* held = device;
  if (dt > 0.01) dt = 0.01; // limits the step after a pause, which would oscillate
  for (int i = 0; i < 3; ++i) {
    const double pull = stiffness * (held->home[i] - held->position[i]);
    // Implicit damping (new velocity): stable for any dt.
    held->velocity[i] =
        (held->velocity[i] + dt / mass * (force[i] + pull)) / (1 + dt / mass * damping);
    held->position[i] += dt * held->velocity[i];
    state->position[i] = held->position[i];
    state->velocity[i] = held->velocity[i];
  }
  state->has_velocity = 1;
  return 0;
}

const patina_device* patina_device_entry(void) {
  static const patina_device entry = {
      PATINA_DEVICE_ABI, sizeof(patina_device), describe, open_hand, exchange, free};
  return &entry;
}
