// A USB device by script: its expected transfers in order, and their answers.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "usb/usb_transport.h"

namespace patina::test {

using Bytes = std::vector<std::byte>;

inline Bytes bytes(std::initializer_list<int> values) {
  Bytes list;
  for (const int value : values) list.push_back(static_cast<std::byte>(value));
  return list;
}

struct UsbStep {
  enum class Kind { claim, control_out, control_in, write, read };
  Kind kind = Kind::claim;
  int where = 0;        // interface, or endpoint
  UsbRequest request{}; // request of a control transfer
  Bytes data{};         // bytes to expect or to answer
  UsbResult result = UsbResult::ok;
};

// A call that is not in the script fails and is kept as complaint(); so does every call after it. A
// removed device stays removed.
class ScriptedTransport final : public UsbTransport {
 public:
  explicit ScriptedTransport(std::vector<UsbStep> steps) : steps_(std::move(steps)) {}

  bool done() const { return next_ == steps_.size() && complaint_.empty(); }
  const std::string& complaint() const { return complaint_; }

  UsbResult claim(int number) noexcept override {
    return take(UsbStep::Kind::claim, number, {}, {}).first;
  }
  UsbCount controlOut(const UsbRequest& request, std::span<const std::byte> data,
                      unsigned) noexcept override {
    return out(UsbStep::Kind::control_out, 0, request, data);
  }
  UsbCount controlIn(const UsbRequest& request, std::span<std::byte> data,
                     unsigned) noexcept override {
    return in(UsbStep::Kind::control_in, 0, request, data);
  }
  UsbCount write(std::uint8_t endpoint, std::span<const std::byte> data,
                 unsigned) noexcept override {
    return out(UsbStep::Kind::write, endpoint, {}, data);
  }
  UsbCount read(std::uint8_t endpoint, std::span<std::byte> data, unsigned) noexcept override {
    return in(UsbStep::Kind::read, endpoint, {}, data);
  }

 private:
  using Sent = std::optional<std::span<const std::byte>>;

  static bool same(const UsbRequest& a, const UsbRequest& b) {
    return a.request_type == b.request_type && a.request == b.request && a.value == b.value &&
           a.index == b.index;
  }
  std::pair<UsbResult, const UsbStep*> take(UsbStep::Kind kind, int where,
                                            const UsbRequest& request, const Sent& sent) {
    if (gone_) return {UsbResult::gone, nullptr};
    if (!complaint_.empty()) return {UsbResult::failed, nullptr};
    const UsbStep* step = next_ < steps_.size() ? &steps_[next_] : nullptr;
    const char* wrong = !step                                            ? "the script has ended"
                        : step->kind != kind                             ? "another kind of call"
                        : step->where != where                           ? "another address"
                        : !same(step->request, request)                  ? "another request"
                        : sent && !std::ranges::equal(step->data, *sent) ? "other bytes"
                                                                         : nullptr;
    if (wrong) {
      complaint_ = "call " + std::to_string(next_) + ": " + wrong;
      return {UsbResult::failed, nullptr};
    }
    ++next_;
    gone_ = step->result == UsbResult::gone;
    return {step->result, step};
  }
  UsbCount out(UsbStep::Kind kind, int where, const UsbRequest& request,
               std::span<const std::byte> data) {
    const auto [result, step] = take(kind, where, request, data);
    return {result, result == UsbResult::ok ? data.size() : 0};
  }
  UsbCount in(UsbStep::Kind kind, int where, const UsbRequest& request, std::span<std::byte> data) {
    const auto [result, step] = take(kind, where, request, std::nullopt);
    const std::size_t count = step ? std::min(step->data.size(), data.size()) : 0;
    if (step) std::copy_n(step->data.begin(), count, data.begin());
    return {result, count};
  }

  std::vector<UsbStep> steps_;
  std::size_t next_ = 0;
  bool gone_ = false;
  std::string complaint_;
};

} // namespace patina::test
