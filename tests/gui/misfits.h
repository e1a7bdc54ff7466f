// What does not fit in a window: its widgets are walked, and each that is cut, covered or mute is
// named.
#pragma once

#include <QStringList>
#include <QWidget>

namespace patina::test {

// Text that is cut, widgets over one another or beyond what holds them.
QStringList misfits(const QWidget& window);
// Controls that have no tooltip, nor stand in something small that has one.
QStringList muteControls(const QWidget& window);

} // namespace patina::test
