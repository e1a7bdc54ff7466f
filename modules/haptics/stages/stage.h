// One term of the force. Stages are immutable and shared; what changes lives in ContactMemory.
// Field and objects are the snapshot's: a stage views them.
#pragma once

#include "haptics/contact/contact.h"

namespace patina {

struct ContactMemory;

class ForceStage {
 public:
  virtual ~ForceStage() = default;
  // Servo thread: no lock, allocation, throw.
  virtual void apply(Contact& contact, ContactMemory& memory) const noexcept = 0;
};

} // namespace patina
