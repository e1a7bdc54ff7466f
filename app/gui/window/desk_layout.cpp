#include "app/gui/window/desk_layout.h"

#include <QSettings>

namespace patina {
namespace {

QString keyOf(Desk desk, const char* what) {
  return QStringLiteral("desks/%1/%2").arg(QString::fromUtf8(rowOf(desk).name), what);
}

// What an older or newer program has left behind may be no value of this one's.
template <typename Value> Value read(const QString& key, Value usual, int low, int high) {
  bool is_number = false;
  const int kept = QSettings().value(key).toInt(&is_number);
  return is_number && kept >= low && kept <= high ? static_cast<Value>(kept) : usual;
}

} // namespace

DeskLayout usualLayout(Desk desk) {
  const DeskRow& row = rowOf(desk);
  return {row.tab, row.page, 300, row.drawer, false, !row.drawer_open};
}

DeskLayout rememberedLayout(Desk desk) {
  DeskLayout layout = usualLayout(desk);
  const auto take = [desk](const char* what, auto& value, int low, int high) {
    value = read(keyOf(desk, what), value, low, high);
  };
  take("tab", layout.tab, 0, static_cast<int>(tabRows().size()) - 1);
  take("page", layout.page, static_cast<int>(Panel::forces), static_cast<int>(Panel::basin));
  take("column", layout.column, 300, 480);
  take("drawer", layout.drawer, 60, 4000);
  take("column_folded", layout.column_folded, 0, 1);
  take("drawer_folded", layout.drawer_folded, 0, 1);
  return layout;
}

void remember(Desk desk, const DeskLayout& layout) {
  QSettings settings;
  settings.setValue(keyOf(desk, "tab"), static_cast<int>(layout.tab));
  settings.setValue(keyOf(desk, "page"), static_cast<int>(layout.page));
  settings.setValue(keyOf(desk, "column"), layout.column);
  settings.setValue(keyOf(desk, "drawer"), layout.drawer);
  settings.setValue(keyOf(desk, "column_folded"), static_cast<int>(layout.column_folded));
  settings.setValue(keyOf(desk, "drawer_folded"), static_cast<int>(layout.drawer_folded));
}

WindowPlace rememberedPlace() {
  WindowPlace place;
  const QSize size = QSettings().value(QStringLiteral("window/size")).toSize();
  if (size.isValid()) place.size = size.expandedTo({640, 480});
  place.maximized = QSettings().value(QStringLiteral("window/maximized")).toBool();
  const Desk desk =
      read(QStringLiteral("window/desk"), place.desk, 0, static_cast<int>(Desk::align));
  if (isBuilt(desk)) place.desk = desk;
  return place;
}

void remember(const WindowPlace& place) {
  QSettings settings;
  settings.setValue(QStringLiteral("window/size"), place.size);
  settings.setValue(QStringLiteral("window/maximized"), place.maximized);
  settings.setValue(QStringLiteral("window/desk"), static_cast<int>(place.desk));
}

} // namespace patina
