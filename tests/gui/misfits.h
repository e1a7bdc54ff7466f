// Finds misfits in a window: walks its widgets and names each that is cut, covered or has no
// tooltip.
#pragma once

#include <QStringList>
#include <QWidget>

namespace patina::test {

// Returns cut texts, and widgets that overlap or leave their parent.
QStringList misfits(const QWidget& window);
// Returns controls without a tooltip, unless a small parent has one.
QStringList muteControls(const QWidget& window);

} // namespace patina::test
