// The sketch of a probe on a board that is made of text: two sensors on a bus, an analog input, a
// clock and a serial port, each of which can fail. The oracle is what the bus gave out.
#include <Arduino.h>
#include <Wire.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <deque>
#include <map>
#include <random>
#include <sstream>

#include "acquisition/firmware/examples/probe_pen/probe_pen.ino"
#include "acquisition/simulation/emulated_probe.h"
#include "acquisition/sources/probe_decoder.h"
#include "support/longer.h"
#include "support/places.h"

namespace {

// An MPU-6050: registers, and counts that change with each reading.
struct FakeImu {
  std::uint8_t registers[128] = {};
  std::array<std::int16_t, 3> acceleration{}, rate{}; // counts at the next reading
  bool plugged = true;
  std::uint8_t name = 0x68;

  void powerUp() {
    std::fill_n(registers, 128, std::uint8_t{0});
    registers[kPower] = 0x40; // asleep
    registers[kWhoAmI] = name;
  }
  void sample() {
    const bool awake = registers[kPower] == 1;
    for (std::size_t i = 0; i < 3; ++i) {
      put(kData + 2 * i, awake ? acceleration[i] : std::int16_t{0});
      put(kData + 8 + 2 * i, awake ? rate[i] : std::int16_t{0});
    }
  }
  void put(std::size_t at, std::int16_t value) {
    registers[at] = static_cast<std::uint8_t>(static_cast<std::uint16_t>(value) >> 8);
    registers[at + 1] = static_cast<std::uint8_t>(value);
  }
};

struct FakeBoard {
  double clock_us = 0; // since the board started
  std::uint32_t first_us = 0;
  FakeImu imu[2];
  int force = 1400;              // reading of the analog input
  bool moves = false;            // all readings change with each sample
  double answerless = 0;         // share of transfers to which no sensor answers
  bool open = true;              // a program has the port
  int room = 256;                // bytes that the port takes
  std::deque<std::uint8_t> keys; // received
  std::vector<std::uint8_t> sent;
  std::string text; // printed
  bool light = false;
  std::uint32_t turns = 0; // number of readings that moved
  std::mt19937 random{5};
  // The transfer that is being made.
  int address = 0;
  std::vector<std::uint8_t> written;
  std::uint8_t pointer[2] = {};
  std::deque<std::uint8_t> answer;
  bool answered = true;

  FakeImu* at(int wanted) {
    FakeImu* found = wanted == 0x68 ? &imu[0] : wanted == 0x69 ? &imu[1] : nullptr;
    return found && found->plugged ? found : nullptr;
  }
  void pass(int bytes) { clock_us += 9 * 2.5 * bytes; } // 400 kHz
  bool fails() {
    return answerless > 0 && std::uniform_real_distribution<double>(0, 1)(random) < answerless;
  }
  void powerUp() {
    clock_us = 0;
    for (FakeImu& each : imu) each.powerUp();
    setup();
  }
};
FakeBoard board;

std::uint32_t hashOf(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  return x ^ x >> 16;
}

// Readings number `n`: any counts but the ends of the range, which are saturated.
void move(std::uint32_t n) {
  for (std::uint32_t i = 0; i < 6; ++i) {
    const auto count = [&](std::uint32_t salt) {
      return static_cast<std::int16_t>(static_cast<int>(hashOf(n * 16 + salt) % 60001) - 30000);
    };
    FakeImu& imu = board.imu[i / 3];
    imu.acceleration[i % 3] = count(i);
    imu.rate[i % 3] = count(6 + i);
  }
  board.force = 1 + static_cast<int>(hashOf(n * 16 + 15) % 4090);
}

} // namespace

SerialPort Serial;
TwoWire Wire;

std::uint32_t micros() {
  board.clock_us += 5;
  return board.first_us + static_cast<std::uint32_t>(static_cast<std::uint64_t>(board.clock_us));
}
void pinMode(int, int) {}
void digitalWrite(int, int level) {
  board.light = level == HIGH;
}
void analogReadResolution(int) {}
int analogRead(int pin) {
  board.clock_us += 5;
  return pin == kForcePin ? board.force : 0;
}
void SerialPort::begin(unsigned long) {}
SerialPort::operator bool() const {
  return board.open;
}
int SerialPort::available() {
  return static_cast<int>(board.keys.size());
}
int SerialPort::read() {
  const int key = board.keys.front();
  board.keys.pop_front();
  return key;
}
int SerialPort::availableForWrite() {
  return board.room;
}
size_t SerialPort::write(uint8_t byte) {
  return write(&byte, 1);
}
size_t SerialPort::write(const uint8_t* bytes, size_t count) {
  board.sent.insert(board.sent.end(), bytes, bytes + count);
  return count;
}
size_t SerialPort::print(const char* text) {
  board.text += text;
  return 0;
}
size_t SerialPort::print(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return print(text);
}
size_t SerialPort::println(double value, int digits) {
  print(value, digits);
  return print("\n");
}
void TwoWire::begin() {}
void TwoWire::setClock(uint32_t) {}
void TwoWire::beginTransmission(uint8_t address) {
  board.address = address;
  board.written.clear();
}
size_t TwoWire::write(uint8_t byte) {
  board.written.push_back(byte);
  return 1;
}
uint8_t TwoWire::endTransmission(bool) {
  board.pass(1 + static_cast<int>(board.written.size()));
  FakeImu* const imu = board.at(board.address);
  if (!imu || board.fails()) return 2; // nobody answers
  std::size_t at = board.written.at(0);
  board.pointer[board.address - 0x68] = static_cast<std::uint8_t>(at);
  for (std::size_t i = 1; i < board.written.size(); ++i) imu->registers[at++] = board.written[i];
  return 0;
}
uint8_t TwoWire::requestFrom(uint8_t address, uint8_t count) {
  board.pass(1 + count);
  board.answer.clear();
  FakeImu* const imu = board.at(address);
  if (!imu || board.fails()) return 0;
  const std::size_t from = board.pointer[address - 0x68];
  if (from == kData) imu->sample();
  for (std::size_t i = 0; i < count; ++i) board.answer.push_back(imu->registers[from + i]);
  return count;
}
int TwoWire::read() {
  const int byte = board.answer.front();
  board.answer.pop_front();
  return byte;
}

namespace patina {
namespace {

struct Sample {
  std::array<std::int16_t, PROBE_MAX_CHANNELS> counts{};
  bool operator==(const Sample&) const = default;
};

// Starts a board at rest: gravity along the pen, nothing pressed.
void startAtRest() {
  board = FakeBoard();
  for (FakeImu& imu : board.imu) imu.acceleration = {0, 0, 4096};
  board.force = 1365;
  board.powerUp();
}

// Lets the sketch take one sample, which moving readings precede.
void takeSample() {
  if (board.moves) move(board.turns++);
  for (const std::uint32_t before = pen.samples; pen.samples == before;) loop();
}

struct Decoded {
  ProbeDecoder decoder;
  ProbeFrames frames;
  std::vector<ProbeSample> samples;
  std::vector<RateSample> rates;

  void take(std::span<const std::uint8_t> bytes) {
    frames.take(std::as_bytes(bytes), [&](ProbePacket packet) {
      decoder.take(packet, arrival += 1e-3, samples, &rates);
    });
  }
  double arrival = 0;
};

TEST(ProbeSketch, SendsWhatItsSensorsShowInSiUnits) {
  startAtRest();
  EXPECT_TRUE(board.light);
  board.imu[0].acceleration = {1000, -2000, 4096};
  board.imu[1].acceleration = {50, 300, -4096};
  board.imu[0].rate = {328, -656, 3280}; // 10, -20 and 100 degrees per second
  board.force = 1365 + 338;              // 2 N
  Decoded got;
  for (int i = 0; i < 1000; ++i) takeSample();
  got.take(board.sent);
  EXPECT_EQ(got.decoder.description().name, "Probe pen");
  EXPECT_TRUE(got.decoder.description().hasGyroscope());
  ASSERT_EQ(got.samples.size(), 1000u);
  ASSERT_EQ(got.rates.size(), 1000u);
  for (std::size_t i = 0; i < 1000; ++i) {
    const ProbeSample& sample = got.samples[i];
    ASSERT_NEAR(sample.t, 1e-3 * static_cast<double>(i), 1e-9);
    ASSERT_NEAR(sample.acceleration[0], 9.80665 * 1000 / 4096, 1e-5);
    ASSERT_NEAR(sample.acceleration[1], 9.80665, 1e-5);
    ASSERT_NEAR(sample.acceleration[2], 9.80665 * 300 / 4096, 1e-5);
    ASSERT_NEAR(sample.acceleration[3], -9.80665, 1e-5);
    ASSERT_NEAR(sample.force, 2, 0.01);
    ASSERT_EQ(got.rates[i].t, sample.t);
    const Vec3 rate = std::numbers::pi / 180 * Vec3(10, -20, 100);
    ASSERT_NEAR((got.rates[i].rate - rate).norm(), 0, 1e-5);
  }
  const ProbeHealth health = got.decoder.health();
  EXPECT_EQ(health.lost_packets + health.corrupt + health.repeated + health.silent, 0u);
  EXPECT_EQ(health.saturated, 0u);
}

TEST(ProbeSketch, TestsItself) {
  const auto print = [] {
    board.keys.push_back('t');
    for (int i = 0; i < 4; ++i) loop();
    return board.text;
  };
  startAtRest();
  const std::string sound = print();
  EXPECT_EQ(std::count(sound.begin(), sound.end(), '\n'), 9);
  EXPECT_EQ(sound.find("WRONG"), std::string::npos) << sound;
  EXPECT_NE(sound.find("gravity of 0x68: 9.81 m/s^2, due 9.32 to 10.30"), std::string::npos)
      << sound;
  EXPECT_NE(sound.find("ok    rate: 1000 Hz"), std::string::npos) << sound;
  EXPECT_NE(sound.find("ok    force at rest: "), std::string::npos) << sound;
  struct Fault {
    const char* line;
    std::function<void()> make;
  };
  for (const Fault& fault :
       {Fault{"WRONG WHO_AM_I of 0x69: 0", [] { board.imu[1].plugged = false; }},
        Fault{"WRONG WHO_AM_I of 0x68: 112", [] { board.imu[0].registers[kWhoAmI] = 0x70; }},
        Fault{"WRONG gravity of 0x69: 10.3",
              [] {
                board.imu[1].acceleration = {0, 1000, 4200};
              }},
        Fault{"WRONG turning at rest: 1.",
              [] {
                board.imu[0].rate = {0, 2000, 0};
              }},
        Fault{"WRONG force at rest: 0.9", [] { board.force = 1365 + 160; }},
        Fault{"WRONG samples without an answer: ", [] { board.answerless = 0.01; }}}) {
    startAtRest();
    fault.make();
    const std::string text = print();
    EXPECT_NE(text.find(fault.line), std::string::npos) << text;
  }
  startAtRest();
  board.imu[1].name = 0x12;
  board.powerUp();
  EXPECT_FALSE(board.light);
}

// The stream goes on after the test with the next numbers.
TEST(ProbeSketch, StreamsAgainAfterItsTest) {
  startAtRest();
  Decoded got;
  for (int i = 0; i < 601; ++i) takeSample();
  board.keys.push_back('t');
  loop();
  for (int i = 0; i < 600; ++i) takeSample();
  got.take(board.sent);
  EXPECT_EQ(got.samples.size(), 1200u);
  EXPECT_EQ(got.decoder.health().lost_packets, 0u);
  EXPECT_EQ(got.decoder.health().restarts, 0u);
  EXPECT_GT(got.samples.back().t, 1.6);
}

TEST(ProbeSketch, TimeGoesOnWhenTheBoardsClockWraps) {
  board = FakeBoard();
  board.imu[0].acceleration = board.imu[1].acceleration = {0, 0, 4096};
  board.first_us = 0xffffffffU - 500'000;
  board.powerUp();
  Decoded got;
  for (int i = 0; i < 2000; ++i) takeSample();
  got.take(board.sent);
  ASSERT_EQ(got.samples.size(), 2000u);
  for (std::size_t i = 0; i < 2000; ++i)
    ASSERT_NEAR(got.samples[i].t, 1e-3 * static_cast<double>(i), 1e-9);
}

TEST(ProbeSketch, KeepsTheLastValuesAndSaysSoIfASensorIsSilent) {
  startAtRest();
  Decoded got;
  board.imu[0].acceleration = {7, 8, 9};
  for (int i = 0; i < 700; ++i) takeSample();
  board.imu[0].plugged = false;
  board.imu[0].acceleration = {1, 2, 3};
  for (int i = 0; i < 100; ++i) takeSample();
  board.imu[0].plugged = true;
  board.imu[0].powerUp(); // asleep, and with its first settings
  for (int i = 0; i < 100; ++i) takeSample();
  got.take(board.sent);
  ASSERT_EQ(got.samples.size(), 900u);
  const double unit = 9.80665 / 4096;
  EXPECT_NEAR(got.samples[750].acceleration[0], 7 * unit, 1e-6);
  EXPECT_NEAR(got.samples[899].acceleration[0], 1 * unit, 1e-6);
  const std::size_t silent = got.decoder.health().silent; // packets
  EXPECT_GE(silent, 50u);
  EXPECT_LE(silent, 50u + 11) << "it is set up again after 20 readings";
  EXPECT_EQ(board.imu[0].registers[kAccRange], 0x10);
}

TEST(ProbeSketch, FillsSamplesThatCameTooLate) {
  startAtRest();
  Decoded got;
  for (int i = 0; i < 1000; ++i) takeSample();
  board.clock_us += 20'000;
  for (int i = 0; i < 100; ++i) takeSample();
  got.take(board.sent);
  ASSERT_EQ(got.samples.size(), 1100u);
  EXPECT_NEAR(got.samples.back().t, 1.099, 1e-9);
  EXPECT_NEAR(static_cast<double>(got.decoder.health().silent), 10, 1);
}

// One line of a probe with faults: frames lost, bits flipped, bytes lost, restarts. Which frame is
// hit depends on the run of the probe and the packet's number only, so that two probes that send
// the same numbers lose the same packets.
class FaultyLine {
 public:
  explicit FaultyLine(Decoded& got) : got_(got) {}

  // Sends a frame; `samples` is empty for a part of the description.
  void send(std::span<const std::uint8_t> frame, std::uint32_t run, std::uint32_t number,
            const std::vector<Sample>& samples) {
    ++sent;
    std::vector<std::uint8_t> line(frame.begin(), frame.end());
    const std::uint32_t salt = hashOf(run * 977 + number) ^ (samples.empty() ? 0x5555U : 0U);
    const std::uint32_t choice = hashOf(salt) % 1000, where = hashOf(salt + 1);
    // A probe's first packets arrive, by which its restart is known.
    const bool faulty = number >= 16 && choice < 6;
    if (faulty && choice < 3) {
      ++lost;
      return;
    }
    if (faulty && choice < 5) line[where % (PROBE_FRAME - 1)] ^= 1U << (where >> 8) % 8;
    if (faulty && choice == 5) line.erase(line.begin() + where % (PROBE_FRAME - 1));
    if (faulty) ++spoilt;
    if (faulty) {
      // Each piece between zeros that is no packet counts as corrupt.
      std::size_t length = 0;
      for (const std::uint8_t byte : line) {
        corrupt += byte == 0 && length > 0;
        length = byte == 0 ? 0 : length + 1;
      }
    } else {
      arrived.insert(arrived.end(), samples.begin(), samples.end());
      packets += !samples.empty();
    }
    got_.take(line);
  }

  std::size_t sent = 0, lost = 0, spoilt = 0; // frames
  std::size_t corrupt = 0;                    // pieces of frames
  std::size_t packets = 0;                    // packets of samples that arrived whole
  std::vector<Sample> arrived;                // samples in them

 private:
  Decoded& got_;
};

// Compares all samples since the last call with those that arrived, and forgets both.
void expectArrived(FaultyLine& line, Decoded& got) {
  ASSERT_EQ(got.samples.size(), line.arrived.size());
  ASSERT_EQ(got.rates.size(), line.arrived.size());
  const ProbeDescription& probe = got.decoder.description();
  for (std::size_t i = 0; i < got.samples.size(); ++i) {
    const auto valueOf = [&](std::size_t k) {
      return probe.channels[k].scale * (line.arrived[i].counts[k] - probe.channels[k].zero);
    };
    const ProbeSample& sample = got.samples[i];
    bool same = sample.force == valueOf(0);
    for (std::size_t k = 0; k < 4; ++k) same = same && sample.acceleration[k] == valueOf(1 + k);
    for (int k = 0; k < 3; ++k)
      same = same && got.rates[i].rate[k] == valueOf(static_cast<std::size_t>(5 + k));
    ASSERT_TRUE(same) << i;
    if (i > 0) {
      ASSERT_GT(sample.t, got.samples[i - 1].t) << i;
    }
  }
  line.arrived.clear();
  got.samples.clear();
  got.rates.clear();
}

struct Outcome {
  ProbeHealth health;
  std::size_t sent, lost, spoilt, packets, seconds;
};

constexpr std::size_t kRuns = 40; // starts of a probe

std::size_t packetsOf(std::size_t total, std::size_t run) {
  return total / kRuns + hashOf(static_cast<std::uint32_t>(run)) % 100 - 50;
}

Outcome outcomeOf(const Decoded& got, const FaultyLine& line) {
  const ProbeHealth health = got.decoder.health();
  EXPECT_EQ(health.packets, line.packets);
  EXPECT_EQ(health.corrupt, line.corrupt);
  EXPECT_EQ(health.restarts, kRuns - 1);
  return {health, line.sent, line.lost, line.spoilt, line.packets, 0};
}

Outcome sketchOutcome(std::size_t total) {
  Decoded got;
  FaultyLine line(got);
  for (std::size_t run = 0; run < kRuns; ++run) {
    startAtRest();
    board.moves = true;
    board.turns = static_cast<std::uint32_t>(run << 24);
    board.answerless = run % 2 == 1 ? 0.002 : 0;
    std::vector<Sample> waiting;
    std::uint32_t number = 0, part = 0;
    while (number < packetsOf(total, run)) {
      board.sent.clear();
      takeSample();
      Sample sample;
      std::copy_n(pen.counts, PROBE_MAX_CHANNELS, sample.counts.begin());
      if (run % 2 == 0) { // every reading came: they are the board's
        const FakeImu &first = board.imu[0], &second = board.imu[1];
        EXPECT_EQ(sample,
                  (Sample{{static_cast<std::int16_t>(8 * board.force), first.acceleration[0],
                           first.acceleration[2], second.acceleration[1], second.acceleration[2],
                           first.rate[0], first.rate[1], first.rate[2]}}));
      }
      waiting.push_back(sample);
      std::span<const std::uint8_t> bytes = board.sent;
      if ((pen.samples - 1) % kDescribeEvery == 0) {
        line.send(bytes.first(PROBE_FRAME), static_cast<std::uint32_t>(run), part++, {});
        bytes = bytes.subspan(PROBE_FRAME);
      }
      if (bytes.empty()) continue;
      line.send(bytes, static_cast<std::uint32_t>(run), number++, waiting);
      waiting.clear();
    }
    expectArrived(line, got);
    if (testing::Test::HasFailure()) break;
  }
  return outcomeOf(got, line);
}

Outcome emulatedOutcome(std::size_t total) {
  Decoded got;
  FaultyLine line(got);
  for (std::size_t run = 0; run < kRuns; ++run) {
    EmulatedProbe probe({.rate = 1000, .gyroscope = true, .describe_every = 0});
    std::uint32_t number = 0, part = 0;
    const auto send = [&](ProbePacket packet, const std::vector<Sample>& samples) {
      std::array<std::uint8_t, PROBE_FRAME> frame;
      probe_frame(reinterpret_cast<const std::uint8_t*>(packet.data()), frame.data());
      line.send(frame, static_cast<std::uint32_t>(run), samples.empty() ? part++ : number++,
                samples);
    };
    for (std::size_t tick = 0; number < packetsOf(total, run); ++tick) {
      if (tick % kDescribeEvery == 0) send(probe.describe(part % probe.parts()), {});
      probe.until(1e-3 * (static_cast<double>(tick) + 0.5), [&](ProbePacket packet, double) {
        const ProbeContent content = parseProbePacket(packet);
        std::vector<Sample> samples;
        for (const auto& counts : std::get<ProbeSamples>(content).counts)
          samples.push_back({counts});
        samples.resize(2);
        send(packet, samples);
      });
    }
    expectArrived(line, got);
    if (testing::Test::HasFailure()) break;
  }
  return outcomeOf(got, line);
}

TEST(ProbeSketch, PacketsAreDecodedAsTheEmulatedProbesDespiteFaults) {
  const std::size_t total = test::isLong() ? 1'000'000 : 100'000;
  const Outcome sketch = sketchOutcome(total), emulated = emulatedOutcome(total);
  EXPECT_EQ(sketch.sent, emulated.sent);
  EXPECT_EQ(sketch.lost, emulated.lost);
  EXPECT_EQ(sketch.spoilt, emulated.spoilt);
  EXPECT_EQ(sketch.packets, emulated.packets);
  EXPECT_EQ(sketch.health.lost_packets, emulated.health.lost_packets);
  EXPECT_EQ(sketch.health.lost_samples, emulated.health.lost_samples);
  EXPECT_EQ(sketch.health.repeated, emulated.health.repeated);
  EXPECT_EQ(sketch.health.restarts, emulated.health.restarts);
  EXPECT_EQ(sketch.health.saturated, 0u);
  EXPECT_GT(sketch.lost, total / 500);
  EXPECT_GT(sketch.spoilt, total / 500);
  std::printf("%zu frames, %zu lost, %zu spoilt: %zu packets decoded, %zu lost, %zu restarts\n",
              sketch.sent, sketch.lost, sketch.spoilt, sketch.health.packets,
              sketch.health.lost_packets, sketch.health.restarts);
}

// Bytes that the port cannot take are whole packets, which their numbers show.
TEST(ProbeSketch, DropsWholePacketsIfTheHostReadsTooSlowly) {
  startAtRest();
  Decoded got;
  for (int i = 0; i < 4000; ++i) {
    board.room = i >= 1000 && i % 10 < 4 ? 65 : 256;
    takeSample();
  }
  got.take(board.sent);
  const ProbeHealth health = got.decoder.health();
  EXPECT_EQ(health.corrupt, 0u);
  EXPECT_EQ(health.packets + health.lost_packets, 2000u);
  EXPECT_NEAR(static_cast<double>(health.lost_packets), 600, 2);
}

// Runs the compiler of the board's processor where it is installed.
TEST(ProbeSketch, CompilesForTheBoardsProcessor) {
  const std::string compiler = "arm-none-eabi-g++";
  const std::string header = "echo '#include <math.h>' | ";
  if (std::system((header + compiler + " -x c++ -E - >/dev/null 2>&1").c_str()) != 0)
    GTEST_SKIP() << compiler
                 << " or its C library is not installed (packages gcc-arm-none-eabi and "
                    "libnewlib-arm-none-eabi)";
  const std::string firmware = (test::sourceFolder() / "modules/acquisition/firmware").string();
  const std::string flags =
      " -mcpu=cortex-m0plus -mthumb -Os -Wall -Wextra -Werror -c -o /dev/null ";
  EXPECT_EQ(std::system((compiler + flags + "-std=gnu++17 -fno-exceptions -fno-rtti -I" + firmware +
                         " -I" + (test::sourceFolder() / "tests/support/arduino").string() +
                         " -x c++ " + firmware + "/examples/probe_pen/probe_pen.ino")
                            .c_str()),
            0);
  EXPECT_EQ(std::system(("arm-none-eabi-gcc" + flags + "-std=c99 -Wconversion " + firmware +
                         "/probe_packer.c")
                            .c_str()),
            0);
}

} // namespace
} // namespace patina
