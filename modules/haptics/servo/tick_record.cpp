#include "haptics/servo/tick_record.h"

namespace patina {

void record(const Contact& contact, ToolSample& sample) noexcept {
  sample.tip = contact.tip;
  sample.force = contact.force;
  sample.vcp = contact.tip;
  sample.surface = contact.tip;
  sample.contact = contact.touching;
  sample.attracted = contact.attracted;
  sample.deep = contact.deep;
  sample.fault = contact.fault;
  sample.relocating = contact.snap;
  sample.constraint_count = static_cast<std::uint8_t>(contact.touching ? contact.walls : 0);
  if (!contact.touching && !contact.attracted) return;
  sample.vcp = contact.vcp;
  sample.surface = contact.surface;
  sample.normal = contact.normal;
  sample.depth = contact.depth;
}

} // namespace patina
