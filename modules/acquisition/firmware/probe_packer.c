#include "probe_packer.h"

#include <string.h>

enum { kContent = 48, kCrcAt = PROBE_PACKET - 4 };

static uint32_t crc_more(uint32_t crc, const uint8_t* bytes, size_t count) {
  static const uint32_t kNibble[16] = {0x00000000, 0x1db71064, 0x3b6e20c8, 0x26d930ac,
                                       0x76dc4190, 0x6b6b51f4, 0x4db26158, 0x5005713c,
                                       0xedb88320, 0xf00f9344, 0xd6d6a3e8, 0xcb61b38c,
                                       0x9b64c2b0, 0x86d3d2d4, 0xa00ae278, 0xbdbdf21c};
  for (size_t i = 0; i < count; ++i) {
    crc ^= bytes[i];
    crc = (crc >> 4) ^ kNibble[crc & 15];
    crc = (crc >> 4) ^ kNibble[crc & 15];
  }
  return crc;
}

uint32_t probe_crc(const uint8_t* bytes, size_t count) {
  return ~crc_more(0xffffffffu, bytes, count);
}

// Little endian on any processor.
static void put(uint8_t* at, uint64_t value, unsigned bytes) {
  for (unsigned i = 0; i < bytes; ++i) at[i] = (uint8_t)(value >> (8 * i));
}

static void put_float(uint8_t* at, float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  put(at, bits, 4);
}

static unsigned channels_of(const probe_description* of) {
  return of->gyroscope ? PROBE_MAX_CHANNELS : PROBE_CHANNELS;
}

static void part_content(const probe_description* of, unsigned part, unsigned most,
                         uint8_t at[kContent]) {
  memset(at, 0, kContent);
  if (part == 0) {
    memcpy(at, of->name, 16);
    memcpy(at + 16, of->serial, 16);
    put(at + 32, of->firmware, 4);
    put(at + 36, of->period_ns, 4);
    put(at + 40, channels_of(of), 2);
    put(at + 42, most, 2);
    return;
  }
  const probe_channel* channel = &of->channel[part - 1];
  memcpy(at, channel->name, 8);
  memcpy(at + 8, channel->unit, 8);
  put_float(at + 16, channel->scale);
  put_float(at + 20, channel->zero);
  put_float(at + 24, channel->low);
  put_float(at + 28, channel->high);
  put_float(at + 32, channel->noise);
  put(at + 36, channel->calibrated, 4);
}

void probe_start(probe_packer* packer, const probe_description* description,
                 unsigned samples_per_packet) {
  memset(packer, 0, sizeof *packer);
  packer->description = description;
  packer->channels = channels_of(description);
  const unsigned fit = sizeof packer->waiting / (2 * packer->channels);
  packer->most = samples_per_packet < 1     ? 1
                 : samples_per_packet > fit ? fit
                                            : samples_per_packet;
  uint32_t crc = 0xffffffffu;
  for (unsigned part = 0; part < probe_parts(packer); ++part) {
    uint8_t content[kContent];
    part_content(description, part, packer->most, content);
    crc = crc_more(crc, content, kContent);
  }
  packer->id = ~crc;
}

unsigned probe_parts(const probe_packer* packer) {
  return 1 + packer->channels;
}

int probe_add(probe_packer* packer, const int16_t* counts, uint64_t time_ns, uint8_t flags,
              uint8_t packet[PROBE_PACKET]) {
  if (packer->count == 0) {
    packer->time_ns = time_ns;
    packer->flags = 0;
    memset(packer->waiting, 0, sizeof packer->waiting);
  }
  packer->flags |= flags;
  uint8_t* const at = packer->waiting + packer->count * packer->channels * 2;
  for (unsigned i = 0; i < packer->channels; ++i) put(at + 2 * i, (uint16_t)counts[i], 2);
  if (++packer->count < packer->most) return 0;

  packet[0] = PROBE_PROTOCOL;
  packet[1] = packer->channels == PROBE_CHANNELS ? 1 : 3; // samples, or those with a gyroscope
  packet[2] = (uint8_t)packer->count;
  packet[3] = packer->flags;
  put(packet + 4, packer->packets, 4);
  put(packet + 8, packer->samples, 4);
  put(packet + 12, packer->time_ns, 8);
  memcpy(packet + 20, packer->waiting, sizeof packer->waiting);
  put(packet + kCrcAt, probe_crc(packet, kCrcAt), 4);
  packer->packets += 1;
  packer->samples += packer->count;
  packer->count = 0;
  return 1;
}

void probe_describe(const probe_packer* packer, unsigned part, uint8_t packet[PROBE_PACKET]) {
  if (part >= probe_parts(packer)) part = 0;
  packet[0] = PROBE_PROTOCOL;
  packet[1] = 2; // description
  packet[2] = (uint8_t)part;
  packet[3] = (uint8_t)probe_parts(packer);
  put(packet + 4, 0, 4);
  put(packet + 8, packer->id, 4);
  part_content(packer->description, part, packer->most, packet + 12);
  put(packet + kCrcAt, probe_crc(packet, kCrcAt), 4);
}

void probe_frame(const uint8_t packet[PROBE_PACKET], uint8_t frame[PROBE_FRAME]) {
  unsigned from = 0, to = 1; // `from`: position of the current run's count
  for (unsigned i = 0; i < PROBE_PACKET; ++i) {
    if (packet[i] == 0) {
      frame[from] = (uint8_t)(to - from);
      from = to++;
    } else {
      frame[to++] = packet[i];
    }
  }
  frame[from] = (uint8_t)(to - from);
  frame[to] = 0;
}
