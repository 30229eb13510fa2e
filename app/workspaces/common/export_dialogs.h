#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <QImage>
#include <QString>
#include <QWidget>

#include "app/studio/base/settings.h"
#include "app/workspaces/common/field_output.h"

namespace lumorph::studio {

/// The small windows that exports and imports ask with. All are modal to the window only, so that the loop goes on
/// behind them, and hand over what was chosen when they are accepted.

/// One kind of file in a file dialog.
struct SaveKind {
    QString text;   ///< "Wavefront OBJ"
    QString suffix; ///< "obj"
};
/// Asks where to save; asks again before it replaces a file. `id` names the dialog; the folder used last is kept.
/// `name` is without an ending: that follows the kind.
void askFile(QWidget* parent, Settings& settings, const QString& id, const QString& title, const QString& name,
             const std::vector<SaveKind>& kinds, std::function<void(const QString&)> chosen);
/// Asks for a file that is there. `filter`: "Calibrations (*.json *.yaml)".
void askFileToOpen(QWidget* parent, Settings& settings, const QString& id, const QString& title, const QString& filter,
                   std::function<void(const QString&)> chosen);
/// Asks for a folder that is to be made. `accept`: of the button.
void askNewFolder(QWidget* parent, Settings& settings, const QString& id, const QString& title, const QString& name,
                  std::function<void(const QString&)> chosen, const QString& accept);
/// Asks for a folder that is there. `accept`: of the button; empty: "Export here".
void askFolder(QWidget* parent, Settings& settings, const QString& id, const QString& title,
               std::function<void(const QString&)> chosen, const QString& accept = {});

/// Which shape to write: where the device stands, or where it is asked to be.
void askShape(QWidget* parent, std::function<void(bool estimated)> chosen);

/// Draws a small picture for a dialog to show; the callback gets it later, in the window's thread.
using PreviewPainter = std::function<void(const PictureStyle&, std::function<void(QImage)>)>;
/// Size, theme and grid of a picture, with a preview. `ratio`: width to height of the view.
void askPicture(QWidget* parent, const PictureStyle& start, double ratio, const PreviewPainter& preview,
                std::function<void(const PictureStyle&)> chosen);
/// Length, size and frame rate of a turntable video.
void askTurntable(QWidget* parent, const Turntable& start, const PreviewPainter& preview,
                  std::function<void(const Turntable&)> chosen);

} // namespace lumorph::studio
