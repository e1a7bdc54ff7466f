// Menus, and the bar below them.
#pragma once

#include "app/gui/control/controllers.h"
#include "app/gui/window/window_layout.h"

namespace patina {

// Adds to parts.commands.
void addMenus(QMainWindow& window, WindowParts& parts, const Controllers& controllers);

} // namespace patina
