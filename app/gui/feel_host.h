// The servo as the window sees it: publish, aim, drain. UI thread only.
#pragma once

#include <memory>
#include <vector>

#include "haptics/servo_loop.h"

namespace patina {

class FeelHost {
 public:
  // Starts a new loop whose mouse device rests at `start`. The old loop, if any, stops first.
  void open(std::shared_ptr<const HapticSnapshot> snapshot, const Vec3& start);
  void publish(std::shared_ptr<const HapticSnapshot> snapshot); // values changed, contact goes on
  void close();
  bool running() const { return loop_ != nullptr; }

  void setTarget(const Vec3& target); // any one thread at a time; never waits
  std::vector<ToolSample> drain();    // since the last call, oldest first
  ServoTiming timing() const;
  std::size_t dropped() const; // samples that nobody drained in time

 private:
  std::unique_ptr<ServoLoop> loop_;
  MouseDevice* mouse_ = nullptr; // owned by the loop
};

} // namespace patina
