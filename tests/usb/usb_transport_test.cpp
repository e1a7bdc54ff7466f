// The interface between a driver and the bus, and the script that replaces a device.
#include "support/scripted_transport.h"

#include <gtest/gtest.h>

#include <functional>

namespace patina::test {
namespace {

using Kind = UsbStep::Kind;

const UsbRequest kReset{0x40, 0, 1, 0};

TEST(ScriptedTransport, PlaysItsScriptAndReportsItsEnd) {
  ScriptedTransport usb({{Kind::claim, 0},
                         {Kind::control_out, 0, kReset, bytes({7, 8})},
                         {Kind::control_in, 0, {0xc0, 5, 0, 2}, bytes({1, 2, 3})},
                         {Kind::write, 0x02, {}, bytes({0x0a, 0x43})},
                         {Kind::read, 0x81, {}, bytes({1, 0x60, 0x0a})}});
  Bytes into(8);
  EXPECT_EQ(usb.claim(0), UsbResult::ok);
  EXPECT_EQ(usb.controlOut(kReset, bytes({7, 8}), 10).bytes, 2u);
  const UsbCount status = usb.controlIn({0xc0, 5, 0, 2}, into, 10);
  EXPECT_EQ(status.result, UsbResult::ok);
  EXPECT_EQ(Bytes(into.begin(), into.begin() + 3), bytes({1, 2, 3}));
  EXPECT_EQ(usb.write(0x02, bytes({0x0a, 0x43}), 10).bytes, 2u);
  EXPECT_FALSE(usb.done());
  EXPECT_EQ(usb.read(0x81, into, 10).bytes, 3u);
  EXPECT_TRUE(usb.done()) << usb.complaint();
}

TEST(ScriptedTransport, NeverFillsMoreThanItsBuffer) {
  ScriptedTransport usb({{Kind::read, 0x81, {}, bytes({1, 2, 3})}});
  Bytes into = bytes({9, 9, 9});
  EXPECT_EQ(usb.read(0x81, std::span(into).first(2), 1).bytes, 2u);
  EXPECT_EQ(into, bytes({1, 2, 9}));
}

TEST(ScriptedTransport, ReturnsErrorsAsValuesAndKeepsReceivedBytes) {
  ScriptedTransport usb({{Kind::read, 0x81, {}, {}, UsbResult::timeout},
                         {Kind::control_out, 0, kReset, {}, UsbResult::stall},
                         {Kind::read, 0x81, {}, bytes({4}), UsbResult::timeout}});
  Bytes into(4);
  EXPECT_EQ(usb.read(0x81, into, 1).result, UsbResult::timeout);
  EXPECT_EQ(usb.controlOut(kReset, {}, 1).result, UsbResult::stall);
  const UsbCount part = usb.read(0x81, into, 1);
  EXPECT_EQ(part.result, UsbResult::timeout);
  EXPECT_EQ(part.bytes, 1u);
  EXPECT_TRUE(usb.done());
}

TEST(ScriptedTransport, StaysRemovedOnceRemoved) {
  ScriptedTransport usb({{Kind::write, 2, {}, bytes({1}), UsbResult::gone}, {Kind::claim, 0}});
  EXPECT_EQ(usb.write(2, bytes({1}), 1).result, UsbResult::gone);
  EXPECT_EQ(usb.claim(0), UsbResult::gone);
}

TEST(ScriptedTransport, ReportsTheFirstCallOutsideTheScript) {
  const auto complaint = [](const std::function<void(UsbTransport&)>& call) {
    ScriptedTransport usb({{Kind::write, 2, {}, bytes({1, 2})}});
    call(usb);
    EXPECT_FALSE(usb.done());
    EXPECT_EQ(usb.write(2, bytes({1, 2}), 1).result, UsbResult::failed)
        << "all later ones are distrusted";
    return usb.complaint();
  };
  Bytes into(4);
  EXPECT_EQ(complaint([](UsbTransport& usb) { usb.claim(2); }), "call 0: another kind of call");
  EXPECT_EQ(complaint([&](UsbTransport& usb) { usb.read(2, into, 1); }),
            "call 0: another kind of call");
  EXPECT_EQ(complaint([](UsbTransport& usb) {
              usb.write(3, bytes({1, 2}), 1);
            }),
            "call 0: another address");
  EXPECT_EQ(complaint([](UsbTransport& usb) {
              usb.write(2, bytes({1, 3}), 1);
            }),
            "call 0: other bytes");
  ScriptedTransport control({{Kind::control_out, 0, kReset}});
  EXPECT_EQ(control.controlOut({0x40, 0, 2, 0}, {}, 1).result, UsbResult::failed);
  EXPECT_EQ(control.complaint(), "call 0: another request");
  ScriptedTransport empty({});
  EXPECT_EQ(empty.claim(0), UsbResult::failed);
  EXPECT_EQ(empty.complaint(), "call 0: the script has ended");
}

} // namespace
} // namespace patina::test
