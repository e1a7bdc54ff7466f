// One term of the force. Stages are immutable and shared; ContactMemory holds their state. Stages
// refer to the snapshot's field and objects.
#pragma once

#include "haptics/contact/contact.h"

namespace patina {

struct ContactMemory;

class ForceStage {
 public:
  virtual ~ForceStage() = default;
  // Servo thread: neither locks nor allocates nor throws.
  virtual void apply(Contact& contact, ContactMemory& memory) const noexcept = 0;
};

} // namespace patina
