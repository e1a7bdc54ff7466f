// A probe's stream over an emulated bus in simulated time, and over a serial line: the reader loses
// nothing and counts earlier losses.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fcntl.h>
#include <termios.h>
#include <thread>
#include <unistd.h>

#include "acquisition/sources/probe_decoder.h"
#include "acquisition/sources/sources.h"
#include "acquisition/sources/usb_probe.h"
#include "core/descriptor.h"
#include "core/error.h"
#include "support/emulated_probe_usb.h"

namespace patina {
namespace {

using test::EmulatedProbeUsb;
using test::ProbeBus;

struct OnBus {
  explicit OnBus(const EmulatedProbeSpec& spec, ProbeBus with = {}) : probe(spec), bus(with) {}
  std::unique_ptr<ProbeSource> open() {
    return makeUsbProbe(std::make_unique<EmulatedProbeUsb>(probe, bus), "P-1",
                        [this] { return bus.now; });
  }
  EmulatedProbe probe;
  ProbeBus bus;
};

template <class Work> std::string causeOf(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

TEST(ProbeStream, IsReadInItsUnits) {
  OnBus on({.rate = 500, .samples_per_packet = 1});
  const auto source = on.open();
  std::vector<ProbeSample> samples;
  while (samples.size() < 500) ASSERT_TRUE(source->read(samples));
  EXPECT_DOUBLE_EQ(samples[0].t, 0);
  for (std::size_t i = 1; i < samples.size(); ++i)
    ASSERT_NEAR(samples[i].t - samples[i - 1].t, 0.002, 1e-9);
  double most = 0;
  for (const ProbeSample& sample : samples) {
    most = std::max(most, sample.force);
    ASSERT_GE(sample.force, -0.01);
    ASSERT_NEAR(sample.acceleration[1], 9.80665, 0.0736); // half a step
    ASSERT_DOUBLE_EQ(sample.acceleration[0], 0);
  }
  EXPECT_NEAR(most, 1, 0.01);
  const ProbeHealth health = source->health().value();
  EXPECT_EQ(health.packets, samples.size());
  EXPECT_EQ(health.lost_packets + health.corrupt + health.repeated + health.saturated, 0u);
  EXPECT_FALSE(health.skew) << "too early to say";
}

// The figures that the protocol promises: 4 kHz, one hour, one packet of a thousand lost,
// a clock 80 ppm fast, delays of 125 us and some more on each packet.
TEST(ProbeStream, CountsAllLossesAndTracksTheClockForAnHour) {
  OnBus on({.rate = 4000, .skew = 80e-6, .loss = 1e-3, .describe_every = 0},
           {.now = 3, .jitter = 200e-6});
  const auto source = on.open();
  const double begin = on.bus.now;
  std::vector<ProbeSample> samples;
  std::size_t count = 0;
  double last = -1;
  while (on.bus.now - begin < 3600) {
    samples.clear();
    ASSERT_TRUE(source->read(samples));
    count += samples.size();
    for (const ProbeSample& sample : samples) {
      ASSERT_GT(sample.t, last);
      last = sample.t;
    }
  }
  const ProbeHealth health = source->health().value();
  EXPECT_GT(on.bus.lost, 3000u);
  EXPECT_EQ(health.lost_packets, on.bus.lost);
  EXPECT_EQ(health.packets, on.bus.given);
  EXPECT_EQ(count, 4 * health.packets);
  EXPECT_EQ(health.lost_samples, 4 * health.lost_packets);
  EXPECT_EQ(health.corrupt + health.repeated + health.restarts, 0u);
  ASSERT_TRUE(health.skew);
  EXPECT_NEAR(*health.skew, 80e-6, 1e-6);
  RecordProperty("skew_ppm", std::to_string(1e6 * *health.skew));
  RecordProperty("lost", std::to_string(health.lost_packets));
}

TEST(ProbeStream, ClockIsFoundWithinAPartPerMillionInAMinuteEitherWay) {
  for (const double skew : {-80e-6, 0., 80e-6, 5e-3}) {
    OnBus on({.rate = 1000, .samples_per_packet = 1, .skew = skew}, {.now = 1, .jitter = 100e-6});
    const auto source = on.open();
    std::vector<ProbeSample> samples;
    while (on.bus.now < 61) ASSERT_TRUE(source->read(samples));
    EXPECT_NEAR(source->health()->skew.value(), skew, 1e-6);
  }
}

TEST(ProbeStream, CorruptPacketsAreCountedOnceAndAmongTheLost) {
  OnBus on({.rate = 4000, .corrupt = 0.01, .describe_every = 0});
  const auto source = on.open();
  std::vector<ProbeSample> samples;
  while (on.bus.now < 30) ASSERT_TRUE(source->read(samples));
  const ProbeHealth health = source->health().value();
  EXPECT_GT(on.probe.corrupted(), 200u);
  EXPECT_LE(on.probe.corrupted() - health.corrupt, 16u);
  EXPECT_LE(health.corrupt - health.lost_packets, 16u);
  EXPECT_EQ(samples.size(), 4 * health.packets);
}

// Packets of one sample a millisecond with given numbers.
class Numbered {
 public:
  Numbered() {
    for (unsigned part = 0; part < probe_.parts(); ++part)
      decoder.take(probe_.describe(part), 0, samples);
  }
  void send(std::uint32_t packet, std::uint64_t ms) {
    probe_description about{};
    probe_packer packer;
    probe_start(&packer, &about, 1);
    packer.packets = packer.samples = packet;
    const std::int16_t counts[5] = {};
    std::array<std::uint8_t, kProbePacket> raw;
    probe_add(&packer, counts, 1'000'000 * ms, 0, raw.data());
    decoder.take(std::as_bytes(std::span(raw)), 1e-3 * static_cast<double>(arrival_ += 1), samples);
  }
  ProbeDecoder decoder;
  std::vector<ProbeSample> samples;

 private:
  EmulatedProbe probe_{{.rate = 1000, .samples_per_packet = 1}};
  std::uint64_t arrival_ = 0;
};

TEST(ProbeStream, TakesEachNumberOnceAndInOrder) {
  Numbered stream;
  for (const std::uint32_t packet : {5u, 6u, 6u, 9u, 8u, 5u, 10u})
    stream.send(packet, 100 + packet);
  const ProbeHealth health = stream.decoder.health();
  EXPECT_EQ(health.packets, 4u); // 5 6 9 10
  EXPECT_EQ(health.lost_packets, 2u);
  EXPECT_EQ(health.lost_samples, 2u);
  EXPECT_EQ(health.repeated, 3u);
  EXPECT_NEAR(stream.samples.back().t, 0.005, 1e-12);
}

TEST(ProbeStream, SequenceNumbersWrapAround) {
  Numbered stream;
  for (const std::uint32_t ahead : {0u, 1u, 3u, 4u}) stream.send(0xfffffffeu + ahead, 100 + ahead);
  EXPECT_EQ(stream.decoder.health().lost_packets, 1u);
  EXPECT_EQ(stream.decoder.health().restarts, 0u);
  EXPECT_EQ(stream.samples.size(), 4u);
}

TEST(ProbeStream, TimeContinuesIfTheProbeRestarts) {
  Numbered stream;
  for (std::uint32_t i = 0; i < 50; ++i) stream.send(i, 7000 + i);
  for (std::uint32_t i = 0; i < 50; ++i) stream.send(i, 2 + i);
  EXPECT_EQ(stream.decoder.health().restarts, 1u);
  EXPECT_EQ(stream.decoder.health().repeated, 0u);
  ASSERT_EQ(stream.samples.size(), 100u);
  for (std::size_t i = 1; i < 100; ++i)
    EXPECT_NEAR(stream.samples[i].t - stream.samples[i - 1].t, 1e-3, 1e-9) << i;
}

TEST(ProbeStream, DetectsARestartWhoseFirstPacketsAreLost) {
  Numbered stream;
  for (std::uint32_t i = 0; i < 250; ++i) stream.send(i, 2 + i);
  for (std::uint32_t i = 1; i < 200; ++i) stream.send(i, 2 + i); // all of them arrived
  EXPECT_EQ(stream.decoder.health().restarts, 1u);
  EXPECT_EQ(stream.decoder.health().repeated, 0u);
  ASSERT_EQ(stream.samples.size(), 449u);
  for (std::size_t i = 1; i < 449; ++i) EXPECT_GT(stream.samples[i].t, stream.samples[i - 1].t);
}

TEST(ProbeStream, RepeatedPacketsAreNoRestart) {
  Numbered stream;
  for (std::uint32_t i = 0; i < 50; ++i) stream.send(i, 2 + i);
  for (std::uint32_t i = 43; i < 60; ++i) stream.send(i, 2 + i);
  EXPECT_EQ(stream.decoder.health().restarts, 0u);
  EXPECT_EQ(stream.decoder.health().repeated, 7u);
  EXPECT_EQ(stream.samples.size(), 60u);
}

TEST(ProbeStream, ReportsAMissingDescription) {
  ProbeDecoder decoder;
  EmulatedProbe probe({.rate = 4000, .samples_per_packet = 1, .describe_every = 0});
  std::vector<ProbeSample> samples;
  const std::string cause = causeOf([&] {
    probe.until(10, [&](ProbePacket packet, double sent) { decoder.take(packet, sent, samples); });
  });
  EXPECT_NE(cause.find("without their description"), std::string::npos);
  EXPECT_TRUE(samples.empty());
}

// The same stream with and without a gyroscope: force and accelerations are equal.
TEST(ProbeStream, ContainsTheGyroscopeOfAProbeThatHasOne) {
  OnBus on({.rate = 1000, .samples_per_packet = 2, .gyroscope = true});
  OnBus without({.rate = 1000, .samples_per_packet = 2});
  const auto source = on.open(), plain = without.open();
  std::vector<ProbeSample> samples, others;
  std::vector<RateSample> rates, none;
  while (samples.size() < 1000) ASSERT_TRUE(source->read(samples, &rates));
  while (others.size() < 1000) ASSERT_TRUE(plain->read(others, &none));
  EXPECT_TRUE(none.empty());
  ASSERT_EQ(rates.size(), samples.size());
  // The probe's clock began before its stream.
  const double before = std::asin(rates[0].rate.z() / 2) / (2 * std::numbers::pi);
  for (std::size_t i = 0; i < 1000; ++i) {
    ASSERT_EQ(rates[i].t, samples[i].t);
    ASSERT_EQ(samples[i].t, others[i].t);
    ASSERT_EQ(samples[i].force, others[i].force);
    ASSERT_EQ(samples[i].acceleration, others[i].acceleration);
    ASSERT_EQ(rates[i].rate.head<2>().norm(), 0);
    const double turning = 2 * std::sin(2 * std::numbers::pi * (samples[i].t + before));
    ASSERT_NEAR(rates[i].rate.z(), turning, 2e-3);
  }
}

TEST(ProbeStream, ReportsAGyroscopeThatComesOrGoes) {
  for (const bool described : {false, true}) {
    EmulatedProbe with({.rate = 1000, .gyroscope = true}), without({.rate = 1000});
    ProbeDecoder decoder;
    std::vector<ProbeSample> samples;
    const auto send = [&](EmulatedProbe& probe, double t) {
      probe.until(t, [&](ProbePacket packet, double sent) { decoder.take(packet, sent, samples); });
    };
    send(without, 2);
    ASSERT_GT(samples.size(), 1000u);
    for (unsigned part = 0; described && part < with.parts(); ++part)
      decoder.take(with.describe(part), 3, samples);
    EXPECT_NE(causeOf([&] { send(with, 4); })
                  .find(described ? "started again with a gyroscope: record again"
                                  : "describes 5 channels and sends samples of 8"),
              std::string::npos);
  }
}

TEST(UsbProbe, ReportsFaultsInOneLine) {
  const auto opening = [](ProbeBus with) {
    OnBus on({}, with);
    return causeOf([&] { (void)on.open(); });
  };
  EXPECT_EQ(opening({.claim = UsbResult::failed}),
            "the probe P-1 is in use by another program: close that program");
  EXPECT_EQ(opening({.claim = UsbResult::gone}), "the probe P-1 is gone: plug it in again");
  EXPECT_NE(opening({.describe = UsbResult::stall}).find("load firmware of this version"),
            std::string::npos);
  EXPECT_NE(opening({.describe = UsbResult::gone}).find("its hub lost power"), std::string::npos);
  const auto reading = [](ProbeBus with) {
    OnBus on({}, {});
    const auto source = on.open();
    with.now = on.bus.now;
    on.bus = with;
    std::vector<ProbeSample> samples;
    const std::string cause = causeOf([&] {
      while (source->read(samples) && on.bus.now < 20) {
      }
    });
    EXPECT_EQ(samples.size() % 4, 0u);
    return cause + (samples.empty() ? ", nothing before" : "");
  };
  EXPECT_EQ(reading({.gone_at = 1.5}),
            "the probe P-1 is gone: it was pulled out, or its hub lost power");
  EXPECT_EQ(reading({.read = UsbResult::stall}),
            "the probe P-1 cannot be read: plug it in again, without a hub, nothing before");
  OnBus mute({}, {.streams = false});
  const auto source = mute.open();
  std::vector<ProbeSample> samples;
  EXPECT_EQ(causeOf([&] { source->read(samples); }),
            "the probe P-1 has sent nothing for 2 s: plug it in again");
  EXPECT_LT(mute.bus.now, 2.5);
}

TEST(UsbProbe, ContinuesAfterAStall) {
  OnBus on({}, {.stall_from = 1, .stall_to = 1.5});
  const auto source = on.open();
  std::vector<ProbeSample> samples;
  EXPECT_EQ(causeOf([&] {
              while (on.bus.now < 3 && source->read(samples)) {
              }
            }),
            "nothing");
  ASSERT_GT(samples.size(), 1000u);
  EXPECT_GT(samples.back().t - samples.front().t, 2.9);
  for (std::size_t i = 1; i < samples.size(); ++i) ASSERT_GT(samples[i].t, samples[i - 1].t) << i;
  on.bus.stall_from = on.bus.now, on.bus.stall_to = 1e300; // a permanent stall
  EXPECT_EQ(causeOf([&] {
              while (source->read(samples)) {
              }
            }),
            "the probe P-1 cannot be read: plug it in again, without a hub");
}

TEST(UsbProbe, StartsAndStopsTheStreamOnRequest) {
  OnBus on({});
  {
    const auto source = on.open();
    EXPECT_EQ(on.bus.starts, 1);
    std::vector<ProbeSample> samples;
    EXPECT_TRUE(source->read(samples));
    source->stop();
    EXPECT_FALSE(source->read(samples));
  }
  EXPECT_EQ(on.bus.stops, 2) << "what an earlier program left, and its own";
}

class SerialLine : public testing::Test {
 protected:
  SerialLine() : end_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    if (::grantpt(end_.get()) == 0 && ::unlockpt(end_.get()) == 0) path = ::ptsname(end_.get());
  }
  void send(std::string_view bytes) {
    ASSERT_EQ(::write(end_.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  void send(ProbePacket packet) {
    std::array<std::uint8_t, PROBE_FRAME> frame;
    probe_frame(reinterpret_cast<const std::uint8_t*>(packet.data()), frame.data());
    send(std::string_view(reinterpret_cast<const char*>(frame.data()), frame.size()));
  }
  void hangUp() { end_.close(); }
  std::string path;

 private:
  Descriptor end_;
};

TEST_F(SerialLine, CarriesPacketsJoinedInTheMiddle) {
  const auto source = openProbe("serial:" + path);
  EXPECT_TRUE(source->isLive());
  send("the end of a packet that was under way");
  send(std::string_view("\0", 1));
  EmulatedProbe probe({.rate = 1000, .describe_every = 0.02});
  std::vector<ProbeSample> samples;
  std::size_t sent = 0;
  for (int step = 1; step <= 50; ++step) {
    probe.until(0.01 * step, [&](ProbePacket packet, double) {
      ++sent;
      send(packet);
    });
    if (step < 12) continue; // six parts by then
    ASSERT_TRUE(source->read(samples));
  }
  while (source->health()->packets < probe.made()) ASSERT_TRUE(source->read(samples));
  EXPECT_GT(sent, probe.made());
  EXPECT_EQ(samples.size(), 4 * probe.made());
  EXPECT_EQ(source->health()->corrupt, 0u);
  EXPECT_EQ(source->health()->lost_packets, 0u);
  hangUp();
  EXPECT_NE(causeOf([&] { source->read(samples); }).find("pulled out or hung up"),
            std::string::npos);
}

// Bytes sent before the port was opened are no current samples.
TEST_F(SerialLine, IgnoresBytesReceivedBeforeOpening) {
  const Descriptor other(::open(path.c_str(), O_RDWR | O_NOCTTY)); // keeps the bytes in the line
  EmulatedProbe probe({.rate = 1000, .describe_every = 0.02});
  const auto sendUntil = [&](double t) {
    probe.until(t, [&](ProbePacket packet, double) { send(packet); });
  };
  sendUntil(0.04);
  const std::size_t before = probe.made();
  const auto source = openProbe("serial:" + path);
  std::vector<ProbeSample> samples;
  for (int step = 5; step <= 30; ++step) sendUntil(0.01 * step);
  while (source->health()->packets < probe.made() - before) ASSERT_TRUE(source->read(samples));
  EXPECT_EQ(samples.size(), 4 * (probe.made() - before));
  EXPECT_EQ(source->health()->lost_packets, 0u);
}

TEST_F(SerialLine, IsSetToTheRateInItsName) {
  const auto rateOf = [this] {
    const Descriptor end(::open(path.c_str(), O_RDWR | O_NOCTTY));
    termios serial{};
    EXPECT_EQ(::tcgetattr(end.get(), &serial), 0);
    return ::cfgetispeed(&serial);
  };
  for (const char* kind : {"serial:", "stream:"}) {
    const auto source = openProbe(kind + path + "@460800");
    EXPECT_EQ(rateOf(), speed_t{B460800});
    const auto other = openProbe(kind + path + "@115200");
    EXPECT_EQ(rateOf(), speed_t{B115200});
    const auto same = openProbe(kind + path);
    EXPECT_EQ(rateOf(), speed_t{B115200});
  }
  EXPECT_NE(causeOf([&] {
              (void)openProbe("serial:" + path + "@123457");
            }).find(path + ": 123457 is no rate of serial lines: those are 9600,"),
            std::string::npos);
  for (const char* word : {"", "fast", "-9600", "9600.5", "nan"})
    EXPECT_EQ(causeOf([&] { (void)openProbe("stream:" + path + "@" + word); }),
              path + "@" + word + ": '" + word +
                  "' is no rate of a serial line: write bits a second after @");
}

TEST_F(SerialLine, ReportsTheRemedyIfItCarriesText) {
  const auto source = openProbe("serial:" + path);
  std::thread talks([this] {
    for (int i = 0; i < 400; ++i) {
      send("0.002,0.1,0,9.8,0,9.8\n");
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  });
  std::vector<ProbeSample> samples;
  const std::string cause = causeOf([&] {
    while (source->read(samples)) {
    }
  });
  talks.join();
  EXPECT_EQ(cause,
            path +
                ": what it sends are no packets of a probe: for lines of text say stream:" + path);
}

} // namespace
} // namespace patina
