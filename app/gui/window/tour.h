// A scripted session: opens a file, touches it through the real servo, and leaves pictures and a
// log. For machines without a person in front of them, and for the documentation.
#pragma once

#include <filesystem>

#include "app/gui/window/main_window.h"

namespace patina {

// Writes window.png, feel.png, nodes.png, slice.png, offset.png, magnet.png, stability.png,
// objects.png and feel.csv into `folder`. The window must be
// shown. Throws Error, in one line, if the file does not open, nothing is drawn, or the tip felt
// nothing.
void runTour(MainWindow& window, const LoadRequest& request, const std::filesystem::path& folder);

} // namespace patina
