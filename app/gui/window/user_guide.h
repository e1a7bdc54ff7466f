// docs/user_guide.md, as it was when the program was built, in a window of its own.
#pragma once

#include <QWidget>

namespace patina {

void showGuide(QWidget& over); // the one that is open comes to the front

} // namespace patina
