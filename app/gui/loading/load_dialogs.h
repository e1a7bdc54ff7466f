// Questions and bad news around opening a file. None of them blocks: each is a window of its own
// that is gone when it is answered.
#pragma once

#include <functional>

#include <QString>
#include <QWidget>

#include "geometry/mesh/mesh_unit.h"

namespace patina {

// What unit a mesh is in whose size in millimetres makes little sense, and what is up in it;
// longest in file units.
void askUnit(QWidget* parent, const QString& name, double longest, UpAxis up,
             std::function<void(MeshUnit, UpAxis)> answer);

// Which value of a volume is the surface.
void askIso(QWidget* parent, const QString& name, double low, double high,
            std::function<void(double)> answer);

// Whether of a workspace that is damaged what can be read is to be opened.
void askRecover(QWidget* parent, const QString& name, const QString& message,
                std::function<void()> yes);

// One line of what went wrong, and what to do about it where that can be said.
void showProblem(QWidget* parent, const QString& title, const QString& message,
                 const QString& advice);
QString adviceFor(const QString& message);

} // namespace patina
