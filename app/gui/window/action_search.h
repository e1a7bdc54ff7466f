// All that can be done, found by a word of it.
#pragma once

#include <QMainWindow>

namespace patina {

// A field over the window and below it the actions of the menus that hold every word that is typed,
// with their keys; what cannot be done now is grey. Return or a click does the chosen one, Esc
// none.
void searchActions(QMainWindow& window);

} // namespace patina
