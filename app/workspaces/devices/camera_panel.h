#pragma once

#include <memory>

#include <QImage>
#include <QLabel>
#include <QWidget>

#include "devices/trackers/tracker.h"

namespace lumorph::studio {

/// What a camera sees of a marker board: a small live picture, how well the board fits, and what is assumed.
class CameraPanel : public QWidget {
public:
    /// Its parts are named "NAME.picture", "NAME.fit" and so on.
    explicit CameraPanel(const QString& name, QWidget* parent = nullptr);
    void show(const TrackerCamera& camera);

private:
    class Picture;
    Picture* picture_;
    QLabel *size_, *fit_, *found_, *lens_;
};

} // namespace lumorph::studio
