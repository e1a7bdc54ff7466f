// Icons that are drawn, so that they are sharp at every scale, and those of the column's tabs.
#pragma once

#include <functional>

#include <QIcon>
#include <QPainter>

#include "app/gui/window/desk.h"

namespace patina {

// `draw` has a square of 20 units and a pen of dark ink.
QIcon drawnIcon(const std::function<void(QPainter&)>& draw);
QIcon iconOf(Tab tab);

} // namespace patina
