#include "gui/x_hand.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>

#include <csignal>
#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <xcb/xcb.h>
#include <xcb/xtest.h>

namespace patina::test {
namespace {

template <typename Reply> using Owned = std::unique_ptr<Reply, decltype(&std::free)>;

template <typename Reply> Owned<Reply> owned(Reply* reply) {
  return {reply, &std::free};
}

xcb_connection_t* of(void* connection) {
  return static_cast<xcb_connection_t*>(connection);
}

struct Key {
  xcb_keycode_t code = 0;
  bool shifted = false; // makes the symbol with Shift
};

// Returns the key that makes a symbol, one without Shift if there is one.
Key keyOf(xcb_connection_t* to, std::uint32_t keysym) {
  const xcb_setup_t* setup = xcb_get_setup(to);
  const auto count = static_cast<std::uint8_t>(setup->max_keycode - setup->min_keycode + 1);
  const auto map = owned(xcb_get_keyboard_mapping_reply(
      to, xcb_get_keyboard_mapping(to, setup->min_keycode, count), nullptr));
  if (map) {
    const xcb_keysym_t* symbols = xcb_get_keyboard_mapping_keysyms(map.get());
    for (const bool shifted : {false, true})
      for (int code = 0; code < count; ++code)
        if (symbols[code * map->keysyms_per_keycode + shifted] == keysym)
          return {static_cast<xcb_keycode_t>(setup->min_keycode + code), shifted};
  }
  std::fprintf(stderr, "no key makes the symbol %#x\n", keysym);
  std::abort();
}

bool managed(xcb_connection_t* to) {
  const char name[] = "_NET_SUPPORTING_WM_CHECK";
  const auto atom =
      owned(xcb_intern_atom_reply(to, xcb_intern_atom(to, 0, sizeof name - 1, name), nullptr));
  const xcb_window_t root = xcb_setup_roots_iterator(xcb_get_setup(to)).data->root;
  const auto value = owned(xcb_get_property_reply(
      to, xcb_get_property(to, 0, root, atom->atom, XCB_ATOM_WINDOW, 0, 1), nullptr));
  return value && xcb_get_property_value_length(value.get()) > 0;
}

} // namespace

XHand::XHand() {
  auto* to = xcb_connect(nullptr, nullptr);
  if (xcb_connection_has_error(to) != 0 || xcb_get_extension_data(to, &xcb_test_id)->present == 0) {
    xcb_disconnect(to);
    return;
  }
  connection_ = to;
}

XHand::~XHand() {
  if (works()) xcb_disconnect(of(connection_));
}

void XHand::fake(std::uint8_t type, std::uint8_t detail, int x, int y) {
  auto* to = of(connection_);
  const xcb_window_t root = xcb_setup_roots_iterator(xcb_get_setup(to)).data->root;
  xcb_test_fake_input(to, type, detail, XCB_CURRENT_TIME, root, static_cast<std::int16_t>(x),
                      static_cast<std::int16_t>(y), 0);
  owned(xcb_get_input_focus_reply(to, xcb_get_input_focus(to), nullptr)); // waits for all before
}

void XHand::moveTo(int x, int y) {
  fake(XCB_MOTION_NOTIFY, 0, x, y);
}

void XHand::button(int number, bool down) {
  fake(down ? XCB_BUTTON_PRESS : XCB_BUTTON_RELEASE, static_cast<std::uint8_t>(number), 0, 0);
}

void XHand::key(std::uint32_t keysym, bool down) {
  constexpr std::uint32_t kShift = 0xffe1;
  const Key made = keyOf(of(connection_), keysym);
  if (made.shifted && down) key(kShift, true);
  fake(down ? XCB_KEY_PRESS : XCB_KEY_RELEASE, made.code, 0, 0);
  if (made.shifted && !down) key(kShift, false);
}

void XHand::mark(std::uint32_t window, std::uint32_t number) {
  xcb_client_message_event_t message = {};
  message.response_type = XCB_CLIENT_MESSAGE;
  message.format = 32;
  message.window = window;
  message.type = kMark;
  message.data.data32[0] = number;
  xcb_send_event(of(connection_), 0, window, 0, reinterpret_cast<const char*>(&message));
  xcb_flush(of(connection_));
}

bool hasWindowManager() {
  static const bool has = [] {
    auto* to = xcb_connect(nullptr, nullptr);
    bool there = xcb_connection_has_error(to) == 0 && managed(to);
    if (!there && fork() == 0) {
      prctl(PR_SET_PDEATHSIG, SIGTERM);
      const int nowhere = open("/dev/null", O_RDWR);
      for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
      execlp("openbox", "openbox", "--sm-disable", nullptr);
      _exit(127);
    }
    for (int i = 0; i < 100 && !there; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
      there = managed(to);
    }
    xcb_disconnect(to);
    return there;
  }();
  return has;
}

} // namespace patina::test
