// Real drivers over emulated devices, whose hand a pointer leads: `device = sim:falcon`.
#pragma once

#include "haptics/devices/link/linked_device.h"
#include "haptics/devices/tip_target.h"

namespace patina {

// The hand's spring goes where the target goes, from its start, which is the middle of the
// workspace.
std::unique_ptr<Device> makeEmulatedFalcon(std::shared_ptr<const TipTarget> target,
                                           std::shared_ptr<LinkNotes> notes);
// The hand pushes the cap until the tip is where the target is.
std::unique_ptr<Device> makeEmulatedSpaceMouse(std::shared_ptr<const TipTarget> target,
                                               std::shared_ptr<LinkNotes> notes);

} // namespace patina
