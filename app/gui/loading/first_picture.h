// How long a person waits for the first picture.
#pragma once

#include "app/gui/window/main_window.h"

namespace patina {

// Opens the file and returns the seconds from the start of this process to the first presented
// frame that shows its mesh. Throws Error if that does not come.
double firstPictureSeconds(MainWindow& window, const LoadRequest& request);

} // namespace patina
