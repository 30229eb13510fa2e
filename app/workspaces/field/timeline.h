#pragma once

#include <QLabel>
#include <QSlider>

#include "app/studio/shell/studio.h"
#include "app/studio/widgets/floating_card.h"

namespace lumorph::studio {

/// Plays, stops and scrubs the target's animation; there while the target has one. Uses the command target.play.
class Timeline : public FloatingCard {
    Q_OBJECT
public:
    explicit Timeline(Studio& studio, QWidget* parent = nullptr);
    /// Follows the newest frame.
    void refresh();

private:
    void scrub(int step);

    Studio& studio_;
    QSlider* slider_;
    QLabel* time_;
};

} // namespace lumorph::studio
