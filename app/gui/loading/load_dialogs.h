// Questions and errors about files. None blocks unless it says so; each closes when answered.
#pragma once

#include <functional>

#include <QString>
#include <QWidget>

#include "geometry/mesh/mesh_unit.h"
#include "session/edit/lay_picture.h"

namespace patina {

// Queries unit and up axis of a mesh of unlikely size; longest: its longest side in file units.
void askUnit(QWidget* parent, const QString& name, double longest, UpAxis up,
             std::function<void(MeshUnit, UpAxis)> answer);

// Queries in which unit a mesh was read and in which it is, and whether its y axis points upwards;
// longest: its longest side as it is shown [m].
void askReread(QWidget* parent, const QString& name, double longest,
               std::function<void(MeshUnit was, MeshUnit now, UpAxis up)> answer);

// Queries the value of a volume at the surface.
void askIso(QWidget* parent, const QString& name, double low, double high,
            std::function<void(double)> answer);

// Queries as what a picture is laid on an object, and how. has_coordinates: the mesh's own ones.
void askPicture(QWidget* parent, const QString& name, bool has_coordinates,
                std::function<void(PictureTarget, Projection)> answer);

// Offers to open the readable part of a damaged workspace.
void askRecover(QWidget* parent, const QString& name, const QString& message,
                std::function<void()> yes);

// Shows what went wrong, and advice if there is any.
void showProblem(QWidget* parent, const QString& title, const QString& message,
                 const QString& advice);
QString adviceFor(const QString& message);

// Asks to save, discard or cancel, and blocks. Returns the button of QMessageBox.
int askToSave(QWidget* parent, const char* name, const QString& title, const QString& message,
              const QString& advice = {});

} // namespace patina
