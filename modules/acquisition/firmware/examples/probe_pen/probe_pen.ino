// Firmware of a probe: two MPU-6050 and a load cell on a Raspberry Pi Pico (RP2040), as wired in
// docs/usb_protocol.md. It sends framed packets over USB's serial port: two bi-axial accelerometers
// and a force, as in Andrews & Lang (2007), and the gyroscope. Any Arduino core with Wire, a 12-bit
// analogRead and 4 kB of memory will do. The letter t makes it test itself and print the result.
#include <Arduino.h>
#include <Wire.h>
#include <math.h>
#include <probe_packer.h>
#include <string.h>

namespace {

// Settings of this pen.
constexpr uint8_t kImus = 2;               // 1: the channels a2u and a2v are those of the first one
constexpr uint8_t kForcePin = 26;          // GP26, the first analog input
constexpr float kNewtonPerCount = 7.4e-4f; // 3.3 V / 32768 / gain 403 / 3.3 mV * 9.81 N
constexpr float kForceZero = 10923;        // counts at a third of 3.3 V
constexpr uint32_t kPeriodUs = 1000;       // the sensors give 1000 samples a second
constexpr uint8_t kPerPacket = 2;          // samples in a packet

constexpr uint8_t kAddresses[] = {0x68, 0x69}; // pin AD0 to ground, and to 3.3 V
constexpr uint8_t kReadings = 8;               // per sample of the force, whose sum is the count
constexpr uint32_t kDescribeEvery = 100;       // samples between parts of the description
constexpr uint8_t kMaxFailures = 20;           // in a row, then a sensor is set up again

// Registers of the MPU-6050 and what is written to them.
enum : uint8_t {
  kRateDivider = 0x19, // 0: 1 kHz
  kFilter = 0x1a,      // 1: 184 Hz
  kRateRange = 0x1b,   // 0x10: 1000 degrees per second
  kAccRange = 0x1c,    // 0x10: 8 g
  kData = 0x3b,        // three accelerations, temperature, three rates; high byte first
  kPower = 0x6b,       // 1: awake, on the gyroscope's clock
  kWhoAmI = 0x75       // reads 0x68
};
constexpr float kGravity = 9.80665f;
constexpr float kAccScale = kGravity / 4096;            // [m/s^2] per count
constexpr float kRateScale = 3.14159265f / 180 / 32.8f; // [rad/s] per count

struct Imu {
  uint8_t address = 0;
  int16_t acceleration[3] = {}, rate[3] = {}; // last counts
  uint8_t failures = 0;                       // reads in a row that failed
};

struct Pen {
  Imu imu[2];
  probe_description description = {};
  probe_packer packer = {};
  uint64_t now_us = 0;  // micros() without its wrap after 71 minutes
  uint32_t last_us = 0; // micros() at now_us
  uint64_t due_us = 0;  // time of the next sample
  uint32_t samples = 0; // number of samples taken
  unsigned part = 0;    // next part of the description
  int16_t counts[PROBE_MAX_CHANNELS] = {};
};
Pen pen;

uint64_t timeUs() {
  const uint32_t now = micros();
  pen.now_us += static_cast<uint32_t>(now - pen.last_us);
  pen.last_us = now;
  return pen.now_us;
}

bool writeRegister(uint8_t address, uint8_t to, uint8_t value) {
  Wire.beginTransmission(address);
  Wire.write(to);
  Wire.write(value);
  return Wire.endTransmission() == 0;
}

bool readRegisters(uint8_t address, uint8_t from, uint8_t* bytes, uint8_t count) {
  Wire.beginTransmission(address);
  Wire.write(from);
  if (Wire.endTransmission(false) != 0) return false;
  if (Wire.requestFrom(address, count) != count) return false;
  for (uint8_t i = 0; i < count; ++i) bytes[i] = static_cast<uint8_t>(Wire.read());
  return true;
}

uint8_t whoAmI(const Imu& imu) {
  uint8_t name = 0;
  return readRegisters(imu.address, kWhoAmI, &name, 1) ? name : 0;
}

bool setUp(const Imu& imu) {
  return whoAmI(imu) == 0x68 && writeRegister(imu.address, kPower, 1) &&
         writeRegister(imu.address, kRateDivider, 0) && writeRegister(imu.address, kFilter, 1) &&
         writeRegister(imu.address, kRateRange, 0x10) &&
         writeRegister(imu.address, kAccRange, 0x10);
}

int16_t wordAt(const uint8_t* bytes) {
  return static_cast<int16_t>(static_cast<uint16_t>(bytes[0] << 8 | bytes[1]));
}

// Reads a sensor; its last values stay if that fails. The second one's rates are not needed. A
// sensor that lost its power sleeps and reads zero, which a sensor that works never does.
bool readImu(Imu& imu, bool with_rates) {
  uint8_t bytes[14];
  const bool came = readRegisters(imu.address, kData, bytes, with_rates ? 14 : 6);
  if (!came || (wordAt(bytes) == 0 && wordAt(bytes + 2) == 0 && wordAt(bytes + 4) == 0)) {
    if (++imu.failures >= kMaxFailures) {
      imu.failures = 0;
      setUp(imu);
    }
    return false;
  }
  imu.failures = 0;
  for (uint8_t i = 0; i < 3; ++i) imu.acceleration[i] = wordAt(bytes + 2 * i);
  for (uint8_t i = 0; with_rates && i < 3; ++i) imu.rate[i] = wordAt(bytes + 8 + 2 * i);
  return true;
}

bool isFull(int16_t count) {
  return count == INT16_MAX || count == INT16_MIN;
}

int16_t readForce() {
  int sum = 0;
  for (uint8_t i = 0; i < kReadings; ++i) sum += analogRead(kForcePin);
  return static_cast<int16_t>(sum);
}

// Reads all sensors into pen.counts. Returns the flags of the sample.
uint8_t readSensors() {
  uint8_t flags = 0;
  for (uint8_t i = 0; i < kImus; ++i)
    if (!readImu(pen.imu[i], i == 0)) flags |= PROBE_SENSOR_SILENT;
  const Imu &first = pen.imu[0], &second = pen.imu[kImus - 1];
  const int16_t counts[PROBE_MAX_CHANNELS] = {readForce(),
                                              first.acceleration[0],
                                              first.acceleration[2],
                                              second.acceleration[1],
                                              second.acceleration[2],
                                              first.rate[0],
                                              first.rate[1],
                                              first.rate[2]};
  memcpy(pen.counts, counts, sizeof counts);
  for (uint8_t i = 1; i < PROBE_MAX_CHANNELS; ++i)
    if (isFull(counts[i])) flags |= PROBE_SATURATED;
  if (counts[0] == 0 || counts[0] == kReadings * 4095) flags |= PROBE_SATURATED;
  return flags;
}

// Drops what the port has no room for: the host sees it by the numbers.
void sendPacket(const uint8_t packet[PROBE_PACKET]) {
  if (!Serial || Serial.availableForWrite() < PROBE_FRAME) return;
  uint8_t frame[PROBE_FRAME];
  probe_frame(packet, frame);
  Serial.write(frame, sizeof frame);
}

void describe() {
  probe_description& about = pen.description;
  strncpy(about.name, "Probe pen", sizeof about.name);
  strncpy(about.serial, "0001", sizeof about.serial);
  about.firmware = 1 << 16;
  about.period_ns = 1000 * kPeriodUs;
  about.gyroscope = 1;
  const char* names[] = {"force", "a1u", "a1v", "a2u", "a2v", "wx", "wy", "wz"};
  for (uint8_t i = 0; i < PROBE_MAX_CHANNELS; ++i) {
    probe_channel& channel = about.channel[i];
    const bool force = i == 0, acceleration = i < PROBE_CHANNELS;
    strncpy(channel.name, names[i], sizeof channel.name);
    strncpy(channel.unit, force ? "N" : acceleration ? "m/s^2" : "rad/s", sizeof channel.unit);
    channel.scale = force ? kNewtonPerCount : acceleration ? kAccScale : kRateScale;
    channel.zero = force ? kForceZero : 0;
    channel.low = channel.scale * ((force ? 0 : -32768) - channel.zero);
    channel.high = channel.scale * (32767 - channel.zero);
    channel.noise = force ? 0.005f : acceleration ? 0.05f : 0.0015f; // of the data sheets
  }
  probe_start(&pen.packer, &about, kPerPacket);
}

// Begins again after a pause: the next sample is due now, and half a packet is given up.
void resume() {
  pen.packer.count = 0;
  pen.due_us = timeUs() + kPeriodUs;
}

float lengthOf(const float v[3]) {
  return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

void printTest(const char* subject, float value, int digits, const char* unit, float low,
               float high) {
  Serial.print(value >= low && value <= high ? "ok    " : "WRONG ");
  Serial.print(subject);
  Serial.print(": ");
  Serial.print(value, digits);
  Serial.print(unit);
  Serial.print(", due ");
  Serial.print(low, digits);
  Serial.print(" to ");
  Serial.println(high, digits);
}

// Prints a line for each test. The pen lies still, and nothing presses its tip.
void testItself() {
  constexpr uint32_t kCount = 500;
  float acceleration[2][3] = {}, rate[3] = {}, force = 0;
  uint32_t silent = 0, longest_us = 0;
  for (uint8_t i = 0; i < kImus; ++i)
    printTest(i == 0 ? "WHO_AM_I of 0x68" : "WHO_AM_I of 0x69", whoAmI(pen.imu[i]), 0, "", 0x68,
              0x68);
  const uint64_t begin = timeUs();
  for (uint32_t n = 0; n < kCount; ++n) {
    while (timeUs() < begin + n * kPeriodUs) {
    }
    const uint64_t before = timeUs();
    if (readSensors() & PROBE_SENSOR_SILENT) ++silent;
    const uint32_t took = static_cast<uint32_t>(timeUs() - before);
    if (took > longest_us) longest_us = took;
    force += kNewtonPerCount * (pen.counts[0] - kForceZero) / kCount;
    for (uint8_t i = 0; i < 3; ++i) {
      for (uint8_t k = 0; k < kImus; ++k)
        acceleration[k][i] += kAccScale * pen.imu[k].acceleration[i] / kCount;
      rate[i] += kRateScale * pen.imu[0].rate[i] / kCount;
    }
  }
  const float seconds = 1e-6f * static_cast<float>(timeUs() - begin - longest_us);
  for (uint8_t k = 0; k < kImus; ++k)
    printTest(k == 0 ? "gravity of 0x68" : "gravity of 0x69", lengthOf(acceleration[k]), 2,
              " m/s^2", 0.95f * kGravity, 1.05f * kGravity);
  printTest("turning at rest", lengthOf(rate), 3, " rad/s", 0,
            0.6f); // 20 degrees per second an axis
  printTest("force at rest", force, 2, " N", -0.5f, 0.5f);
  printTest("samples without an answer", static_cast<float>(silent), 0, "", 0, 0);
  printTest("longest sample", static_cast<float>(longest_us), 0, " us", 0, 0.95f * kPeriodUs);
  printTest("rate", static_cast<float>(kCount - 1) / seconds, 0, " Hz", 0.98e6f / kPeriodUs,
            1.02e6f / kPeriodUs);
  Serial.write(static_cast<uint8_t>(0)); // ends the text for a host that reads frames
}

} // namespace

void setup() {
  pen = Pen();
  pen.last_us = micros();
  Serial.begin(115200); // over USB any rate is the same
  pinMode(LED_BUILTIN, OUTPUT);
  analogReadResolution(12);
  Wire.begin();
  Wire.setClock(400000);
  bool sound = true; // the light is on if all sensors answer
  for (uint8_t i = 0; i < kImus; ++i) {
    pen.imu[i].address = kAddresses[i];
    sound = setUp(pen.imu[i]) && sound;
  }
  digitalWrite(LED_BUILTIN, sound ? HIGH : LOW);
  describe();
  resume();
}

void loop() {
  if (Serial.available() > 0 && Serial.read() == 't') {
    testItself();
    resume();
  }
  const uint64_t now = timeUs();
  if (now < pen.due_us) return;
  // Samples that came too late are filled with the last values.
  const bool late = now - pen.due_us >= kPeriodUs;
  const uint8_t flags = late ? static_cast<uint8_t>(PROBE_SENSOR_SILENT) : readSensors();
  uint8_t packet[PROBE_PACKET];
  if (pen.samples++ % kDescribeEvery == 0) {
    probe_describe(&pen.packer, pen.part, packet);
    pen.part = (pen.part + 1) % probe_parts(&pen.packer);
    sendPacket(packet);
  }
  if (probe_add(&pen.packer, pen.counts, 1000 * pen.due_us, flags, packet)) sendPacket(packet);
  pen.due_us += kPeriodUs;
}
