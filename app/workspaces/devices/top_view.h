#pragma once

#include <vector>

#include <QString>
#include <QWidget>

#include "core/loop/pose_stream.h"

namespace lumorph::studio {

/// Tracked bodies from above, in the frame `world`: x to the right, z, towards who stands before it, down. Each with
/// its axes x (red), y (green) and z (blue), as they look from there.
class TopView : public QWidget {
public:
    struct Body {
        QString name;
        Pose pose;
        bool seen = true;
    };

    explicit TopView(QWidget* parent = nullptr);
    void show(std::vector<Body> bodies);

    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override;

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    std::vector<Body> bodies_;
    double reach_ = 0.5; ///< metres from the origin that are in sight, at least
};

} // namespace lumorph::studio
