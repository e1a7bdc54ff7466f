// A probe's packets: the output of the C packer against bytes written by hand, and the reader's
// result for them, for any other bytes, and for a serial line that loses some.
#include "acquisition/sources/probe_packet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "acquisition/simulation/emulated_probe.h"
#include "core/error.h"

namespace patina {
namespace {

using Raw = std::array<std::uint8_t, kProbePacket>;

ProbePacket bytesOf(const Raw& raw) {
  return std::as_bytes(std::span(raw));
}

probe_description someDescription() {
  probe_description made{};
  std::strcpy(made.name, "Pen");
  std::memcpy(made.serial, "0123456789abcdef", 16); // fills its field without a final zero
  made.firmware = 0x00020003;
  made.period_ns = 250000;
  const char* names[] = {"force", "a1u", "a1v", "a2u", "a2v"};
  for (int i = 0; i < 5; ++i) {
    probe_channel& channel = made.channel[i];
    std::strcpy(channel.name, names[i]);
    std::strcpy(channel.unit, i == 0 ? "N" : "m/s^2");
    channel.scale = 0.25F;
    channel.zero = -4;
    channel.low = -100;
    channel.high = 50;
    channel.noise = 0.5F;
    channel.calibrated = 20001;
  }
  return made;
}

TEST(ProbePacker, ComputesTheStandardChecksum) {
  EXPECT_EQ(probe_crc(reinterpret_cast<const std::uint8_t*>("123456789"), 9), 0xcbf43926U);
}

TEST(ProbePacker, FollowsTheByteLayoutOfTheProtocol) {
  const probe_description about = someDescription();
  probe_packer packer;
  probe_start(&packer, &about, 2);
  Raw raw{};
  const std::int16_t first[5] = {1, -1, 0x0203, -32768, 32767}, second[5] = {6, 7, 8, 9, 10};
  EXPECT_EQ(probe_add(&packer, first, 0x0102030405060708, 0, raw.data()), 0);
  EXPECT_EQ(probe_add(&packer, second, 0x0102030405070000, PROBE_SATURATED, raw.data()), 1);
  const Raw expected{1, 1, 2,   1,   0, 0, 0, 0,   0,   0,   0, 0, 8, 7, 6, 5, 4, 3, 2,  1,
                     1, 0, 255, 255, 3, 2, 0, 128, 255, 127, 6, 0, 7, 0, 8, 0, 9, 0, 10, 0};
  EXPECT_TRUE(std::equal(raw.begin(), raw.begin() + 60, expected.begin()));
  // The values of the next packet.
  EXPECT_EQ(probe_add(&packer, first, 5, 0, raw.data()), 0);
  EXPECT_EQ(probe_add(&packer, first, 6, 0, raw.data()), 1);
  EXPECT_EQ(raw[4], 1);
  EXPECT_EQ(raw[8], 2);
  EXPECT_EQ(raw[3], 0) << "flags are a packet's own";
}

// The first five channels of a probe with a gyroscope are those of one without.
probe_description withGyroscope() {
  probe_description made = someDescription();
  const char* names[] = {"wx", "wy", "wz"};
  for (int i = 0; i < 3; ++i) {
    probe_channel& channel = made.channel[5 + i];
    channel = made.channel[1];
    std::strcpy(channel.name, names[i]);
    std::strcpy(channel.unit, "rad/s");
  }
  made.gyroscope = 1;
  return made;
}

TEST(ProbePacker, HasRoomForTwoSamplesWithAGyroscope) {
  const probe_description about = withGyroscope();
  probe_packer packer;
  probe_start(&packer, &about, 4);
  EXPECT_EQ(packer.most, 2u);
  EXPECT_EQ(probe_parts(&packer), 9u);
  Raw raw{};
  const std::int16_t first[8] = {1, 2, 3, 4, 5, 6, -7, 0x0809}, second[8] = {-1};
  EXPECT_EQ(probe_add(&packer, first, 5, 0, raw.data()), 0);
  EXPECT_EQ(probe_add(&packer, second, 6, 0, raw.data()), 1);
  const Raw expected{1, 3, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 5, 0,   0,   0, 0, 0,   0,
                     0, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0, 249, 255, 9, 8, 255, 255};
  EXPECT_TRUE(std::equal(raw.begin(), raw.begin() + 60, expected.begin()));
  const ProbeContent content = parseProbePacket(bytesOf(raw));
  const auto* read = std::get_if<ProbeSamples>(&content);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->channels, 8u);
  ASSERT_EQ(read->count, 2u);
  EXPECT_TRUE(std::equal(first, first + 8, read->counts[0].begin()));
  EXPECT_TRUE(std::equal(second, second + 8, read->counts[1].begin()));
}

TEST(ProbePacket, IsRejectedIfMoreSamplesAreSaidThanItHolds) {
  for (const auto& [about, most] : {std::pair{someDescription(), 4}, {withGyroscope(), 2}}) {
    probe_packer packer;
    probe_start(&packer, &about, 1);
    Raw raw{};
    const std::int16_t counts[8] = {};
    for (int said = 0; said < 7; ++said) {
      ASSERT_EQ(probe_add(&packer, counts, 5, 0, raw.data()), 1);
      raw[2] = static_cast<std::uint8_t>(said);
      const std::uint32_t crc = probe_crc(raw.data(), 60);
      for (unsigned i = 0; i < 4; ++i) raw[60 + i] = static_cast<std::uint8_t>(crc >> 8 * i);
      EXPECT_EQ(std::holds_alternative<ProbeSamples>(parseProbePacket(bytesOf(raw))),
                said >= 1 && said <= most)
          << said;
    }
  }
}

TEST(ProbePacket, ReadsBackUnchanged) {
  const probe_description about = someDescription();
  probe_packer packer;
  probe_start(&packer, &about, 3);
  packer.packets = 0xfffffffe;
  packer.samples = 17;
  std::mt19937 random(3);
  Raw raw{};
  for (int round = 0; round < 1000; ++round) {
    std::int16_t counts[3][5];
    for (auto& sample : counts)
      for (std::int16_t& count : sample) count = static_cast<std::int16_t>(random());
    const std::uint64_t time = std::uint64_t{random()} << 32 | random();
    int full = 0;
    for (int i = 0; i < 3; ++i)
      full += probe_add(&packer, counts[i], time + 250000U * static_cast<unsigned>(i),
                        i == 1 ? PROBE_SENSOR_SILENT : 0, raw.data());
    ASSERT_EQ(full, 1);
    const ProbeContent content = parseProbePacket(bytesOf(raw));
    const auto* read = std::get_if<ProbeSamples>(&content);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->packet, 0xfffffffe + static_cast<std::uint32_t>(round)); // wraps around
    EXPECT_EQ(read->first, 17U + 3U * static_cast<unsigned>(round));
    EXPECT_EQ(read->time_ns, time);
    EXPECT_EQ(read->count, 3u);
    EXPECT_TRUE(read->sensor_silent);
    EXPECT_FALSE(read->saturated);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_TRUE(std::equal(counts[i], counts[i] + 5, read->counts[i].begin()));
  }
}

TEST(ProbePacket, IsRejectedIfABitOrTheLengthIsWrong) {
  EmulatedProbe probe({});
  Raw raw{};
  std::ranges::copy(std::bit_cast<Raw>(probe.describe(2)), raw.begin());
  ASSERT_TRUE(std::holds_alternative<ProbePart>(parseProbePacket(bytesOf(raw))));
  for (std::size_t bit = 0; bit < 8 * kProbePacket; ++bit) {
    raw[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    EXPECT_TRUE(std::holds_alternative<std::monostate>(parseProbePacket(bytesOf(raw)))) << bit;
    raw[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
  for (std::size_t length = 0; length < kProbePacket; ++length)
    EXPECT_TRUE(
        std::holds_alternative<std::monostate>(parseProbePacket(bytesOf(raw).first(length))));
}

// All parts of a description, in the order given.
bool takeAll(DescriptionAssembler& parts, const probe_description& about,
             std::vector<unsigned> order) {
  probe_packer packer;
  probe_start(&packer, &about, 4);
  bool complete = false;
  for (const unsigned part : order) {
    Raw raw{};
    probe_describe(&packer, part, raw.data());
    complete = parts.take(std::get<ProbePart>(parseProbePacket(bytesOf(raw))));
  }
  return complete;
}

TEST(DescriptionAssembler, AcceptsPartsInAnyOrder) {
  DescriptionAssembler parts;
  ASSERT_FALSE(takeAll(parts, someDescription(), {3, 1, 1, 5, 0}));
  ASSERT_TRUE(takeAll(parts, someDescription(), {4, 2}));
  const ProbeDescription& made = parts.description();
  EXPECT_EQ(made.name, "Pen");
  EXPECT_EQ(made.serial, "0123456789abcdef");
  EXPECT_EQ(made.firmware, 0x00020003U);
  EXPECT_DOUBLE_EQ(made.period, 0.25e-3);
  EXPECT_EQ(made.samples_per_packet, 4u);
  EXPECT_EQ(made.channels[4].name, "a2v");
  EXPECT_EQ(made.channels[0].unit, "N");
  EXPECT_EQ(made.channels[2].scale, 0.25);
  EXPECT_EQ(made.channels[2].zero, -4);
  EXPECT_EQ(made.channels[2].low, -100);
  EXPECT_EQ(made.channels[2].high, 50);
  EXPECT_EQ(made.channels[2].noise, 0.5);
  EXPECT_EQ(made.channels[2].calibrated, 20001U);
}

TEST(DescriptionAssembler, ReadsTheChannelsOfAGyroscope) {
  DescriptionAssembler parts;
  ASSERT_FALSE(takeAll(parts, withGyroscope(), {0, 1, 2, 3, 4, 5}));
  ASSERT_FALSE(takeAll(parts, withGyroscope(), {8, 7}));
  ASSERT_TRUE(takeAll(parts, withGyroscope(), {6}));
  EXPECT_TRUE(parts.description().hasGyroscope());
  EXPECT_EQ(parts.description().channels[7].name, "wz");
  EXPECT_EQ(parts.description().channels[7].unit, "rad/s");
  EXPECT_EQ(parts.description().channels[4].name, "a2v");
  EXPECT_EQ(parts.description().samples_per_packet, 2u);
  ASSERT_TRUE(takeAll(parts, someDescription(), {0, 1, 2, 3, 4, 5}));
  EXPECT_FALSE(parts.description().hasGyroscope());
}

TEST(DescriptionAssembler, DoesNotMixTwoDescriptions) {
  DescriptionAssembler parts;
  probe_description other = someDescription();
  other.channel[0].scale = 9;
  EXPECT_FALSE(takeAll(parts, someDescription(), {0, 1, 2, 3, 4}));
  EXPECT_FALSE(takeAll(parts, other, {5}));
  EXPECT_FALSE(takeAll(parts, other, {0, 2, 3, 4}));
  EXPECT_TRUE(takeAll(parts, other, {1}));
  EXPECT_EQ(parts.description().channels[0].scale, 9);
}

TEST(DescriptionAssembler, ReportsWhyADeviceIsNoProbe) {
  const auto cause = [](const auto& spoil) {
    probe_description about = someDescription();
    spoil(about);
    DescriptionAssembler parts;
    try {
      takeAll(parts, about, {0, 1, 2, 3, 4, 5});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(cause([](auto&) {}), "nothing");
  EXPECT_NE(
      cause([](auto& d) { std::strcpy(d.channel[1].name, "temp\n"); }).find("is temp? [m/s^2]"),
      std::string::npos);
  EXPECT_NE(cause([](auto& d) { std::strcpy(d.channel[0].unit, "lbf"); }).find("force [lbf]"),
            std::string::npos);
  EXPECT_NE(cause([](auto& d) { d.period_ns = 0; }).find("every 0.0"), std::string::npos);
  for (const float bad : {0.F, NAN, INFINITY})
    EXPECT_NE(cause([=](auto& d) { d.channel[3].scale = bad; }).find("calibration of a2u"),
              std::string::npos)
        << bad;
  EXPECT_NE(cause([](auto& d) { d.channel[0].high = d.channel[0].low; }).find("range"),
            std::string::npos);
  DescriptionAssembler parts;
  probe_description about = withGyroscope();
  std::strcpy(about.channel[6].unit, "deg/s");
  EXPECT_THROW(takeAll(parts, about, {0, 1, 2, 3, 4, 5, 6, 7, 8}), Error);
}

// Returns packets; an invalid frame counts as an empty one.
std::vector<std::vector<std::byte>> framesIn(const std::vector<std::byte>& line,
                                             std::size_t piece) {
  std::vector<std::vector<std::byte>> packets;
  ProbeFrames frames;
  for (std::size_t at = 0; at < line.size(); at += piece)
    frames.take(std::span(line).subspan(at, std::min(piece, line.size() - at)),
                [&](ProbePacket packet) { packets.emplace_back(packet.begin(), packet.end()); });
  return packets;
}

TEST(ProbeFrames, RestoreAnyBytesFromAnyPieces) {
  std::mt19937 random(11);
  std::vector<std::byte> line;
  std::vector<std::vector<std::byte>> sent;
  for (int i = 0; i < 2000; ++i) {
    Raw raw{};
    const unsigned zeros = random() % 5; // none, few, many
    for (std::uint8_t& byte : raw)
      byte = random() % 4 < zeros ? 0 : static_cast<std::uint8_t>(random());
    std::array<std::uint8_t, PROBE_FRAME> frame;
    probe_frame(raw.data(), frame.data());
    EXPECT_EQ(std::find(frame.begin(), frame.end(), 0), frame.end() - 1);
    for (const std::uint8_t byte : frame) line.push_back(std::byte{byte});
    sent.emplace_back(bytesOf(raw).begin(), bytesOf(raw).end());
  }
  for (const std::size_t piece : {1u, 7u, 66u, 4096u}) EXPECT_EQ(framesIn(line, piece), sent);
  // The first, partial packet of a joined line is skipped without an error.
  const std::vector<std::byte> joined(line.begin() + 30, line.end());
  EXPECT_EQ(framesIn(joined, 13), std::vector(sent.begin() + 1, sent.end()));
  // A lost or an extra byte costs one packet, which is counted, and no other.
  for (const bool more : {false, true}) {
    std::vector<std::byte> spoilt = line;
    const auto at = spoilt.begin() + 66 * 100 + 9;
    if (more)
      spoilt.insert(at, 70, std::byte{3});
    else
      spoilt.erase(at);
    const auto got = framesIn(spoilt, 50);
    ASSERT_EQ(got.size(), sent.size());
    for (std::size_t i = 0; i < got.size(); ++i)
      EXPECT_EQ(got[i], i == 100 ? std::vector<std::byte>() : sent[i]) << i;
  }
}

} // namespace
} // namespace patina
