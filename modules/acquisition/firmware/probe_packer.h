// Encoder of a probe's packets, for the probe's firmware: docs/usb_protocol.md. C99 without
// allocation or floating-point arithmetic; about 150 bytes of memory. Call it from one context
// (interrupt or main loop) at a time.
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  PROBE_PROTOCOL = 1,
  PROBE_PACKET = 64,      // bytes
  PROBE_FRAME = 66,       // bytes of a packet on a serial line
  PROBE_CHANNELS = 5,     // force, a1u, a1v, a2u, a2v
  PROBE_MAX_CHANNELS = 8, // wx, wy, wz after them, with a gyroscope
  PROBE_SAMPLES = 4,      // largest number per packet; 2 with a gyroscope
  PROBE_PARTS = 6,        // packets per description
  PROBE_MAX_PARTS = 9     // the same with a gyroscope
};

enum { PROBE_SATURATED = 1, PROBE_SENSOR_SILENT = 2 }; // flags of a packet

// A channel's value is scale * (count - zero), in `unit`.
typedef struct {
  char name[8], unit[8]; // filled with zeros
  float scale, zero;
  float low, high;     // measuring range
  float noise;         // standard deviation at rest
  uint32_t calibrated; // days since 1970-01-01; 0: never
} probe_channel;

typedef struct {
  char name[16], serial[16]; // filled with zeros
  uint32_t firmware;         // 65536 * major + minor
  uint32_t period_ns;        // between samples
  probe_channel channel[PROBE_MAX_CHANNELS];
  uint8_t gyroscope; // 0: the first PROBE_CHANNELS channels; 1: all of them
} probe_description;

typedef struct {
  const probe_description* description;
  uint32_t id;          // CRC of the description, sent in all its parts
  uint32_t packets;     // number of packets made
  uint32_t samples;     // number of samples in them
  uint64_t time_ns;     // time of the first pending sample
  unsigned count, most; // pending samples, and samples per packet
  unsigned channels;    // channels per sample
  uint8_t flags;        // flags of the pending samples
  uint8_t waiting[PROBE_SAMPLES * PROBE_CHANNELS * 2];
} probe_packer;

// Counts from 0. `description` outlives the packer; samples_per_packet is 1 to PROBE_SAMPLES, or to
// 2 with a gyroscope; a larger number counts as the largest.
void probe_start(probe_packer* packer, const probe_description* description,
                 unsigned samples_per_packet);

// Adds one sample, a count for each channel, at a time of the probe's clock. Returns 1 if `packet`
// must now be sent, else 0. Drop a packet that cannot be sent; the host detects it by its number.
int probe_add(probe_packer* packer, const int16_t* counts, uint64_t time_ns, uint8_t flags,
              uint8_t packet[PROBE_PACKET]);

// Returns the number of packets per description: PROBE_PARTS, or PROBE_MAX_PARTS.
unsigned probe_parts(const probe_packer* packer);

// Makes packet `part` (from 0) of the description, on request or between samples.
void probe_describe(const probe_packer* packer, unsigned part, uint8_t packet[PROBE_PACKET]);

// Frames a packet for a serial line (COBS, Cheshire & Baker 1999): the only zero is its terminator.
void probe_frame(const uint8_t packet[PROBE_PACKET], uint8_t frame[PROBE_FRAME]);

// CRC-32 of IEEE 802.3.
uint32_t probe_crc(const uint8_t* bytes, size_t count);

#ifdef __cplusplus
}
#endif
