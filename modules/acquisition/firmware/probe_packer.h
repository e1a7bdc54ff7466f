// What a probe sends, made on the probe: docs/usb_protocol.md. C99 without allocation, floating
// point only copied; some 150 bytes of memory. One context (an interrupt, or the loop) at a time.
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  PROBE_PROTOCOL = 1,
  PROBE_PACKET = 64,  // bytes
  PROBE_FRAME = 66,   // bytes of a packet on a serial line
  PROBE_CHANNELS = 5, // force, a1u, a1v, a2u, a2v
  PROBE_SAMPLES = 4,  // a packet holds, at most
  PROBE_PARTS = 6     // of a description, a packet each
};

enum { PROBE_SATURATED = 1, PROBE_SENSOR_SILENT = 2 }; // flags of a packet

// A channel's value is scale * (count - zero), in `unit`.
typedef struct {
  char name[8], unit[8]; // filled with zeros
  float scale, zero;
  float low, high;     // what it can show
  float noise;         // standard deviation at rest
  uint32_t calibrated; // days since 1970-01-01; 0: never
} probe_channel;

typedef struct {
  char name[16], serial[16]; // filled with zeros
  uint32_t firmware;         // 65536 * major + minor
  uint32_t period_ns;        // between samples
  probe_channel channel[PROBE_CHANNELS];
} probe_description;

typedef struct {
  const probe_description* description;
  uint32_t id;          // of the description
  uint32_t packets;     // made so far
  uint32_t samples;     // in them
  uint64_t time_ns;     // of the first that waits
  unsigned count, most; // samples that wait, and that make a packet
  uint8_t flags;        // of those
  uint8_t waiting[PROBE_SAMPLES * PROBE_CHANNELS * 2];
} probe_packer;

// Counts from 0. `description` outlives the packer; samples_per_packet is 1 to PROBE_SAMPLES.
void probe_start(probe_packer* packer, const probe_description* description,
                 unsigned samples_per_packet);

// One sample of all channels, at a time of the probe's own clock. 1 where `packet` is now to be
// sent, else 0. A packet that cannot be sent is thrown away: its number tells the host.
int probe_add(probe_packer* packer, const int16_t counts[PROBE_CHANNELS], uint64_t time_ns,
              uint8_t flags, uint8_t packet[PROBE_PACKET]);

// Part 0 to PROBE_PARTS - 1 of the description, as a packet; for the request, or between samples.
void probe_describe(const probe_packer* packer, unsigned part, uint8_t packet[PROBE_PACKET]);

// The packet as it goes over a serial line: without a zero but for the one that ends it.
void probe_frame(const uint8_t packet[PROBE_PACKET], uint8_t frame[PROBE_FRAME]);

// CRC-32 of IEEE 802.3.
uint32_t probe_crc(const uint8_t* bytes, size_t count);

#ifdef __cplusplus
}
#endif
