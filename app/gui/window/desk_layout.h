// How a person has arranged each desk, kept from one session to the next.
#pragma once

#include <QSize>

#include "app/gui/window/desk.h"

namespace patina {

struct DeskLayout {
  Tab tab;
  Panel page;
  int column, drawer; // their width and height, where they are not folded
  bool column_folded, drawer_folded;
};

DeskLayout usualLayout(Desk desk);
DeskLayout rememberedLayout(Desk desk); // the usual one where nothing is
void remember(Desk desk, const DeskLayout& layout);

struct WindowPlace {
  QSize size{1280, 800};
  bool maximized = false;
  Desk desk = Desk::feel;
};
WindowPlace rememberedPlace();
void remember(const WindowPlace& place);

} // namespace patina
