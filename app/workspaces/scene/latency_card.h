#pragma once

#include <vector>

#include <QString>

#include "app/studio/rendering/show_feed.h"
#include "app/studio/widgets/floating_card.h"
#include "app/studio/widgets/throttle.h"

namespace lumorph::studio {

/// Where the time of a frame goes, from the tracker to the picture: one line a stage, in milliseconds.
class LatencyCard : public FloatingCard {
    Q_OBJECT
public:
    /// Measures each pass while it is shown. `feed` outlives it.
    explicit LatencyCard(ShowFeed& feed, QWidget* parent = nullptr);
    [[nodiscard]] QSize sizeHint() const override;

    /// What it shows, in the order of the frame's way.
    struct Line {
        QString stage;
        double value = 0.0;
        QString unit;
    };
    [[nodiscard]] static std::vector<Line> linesOf(const ShowFeed& feed);

protected:
    void paintEvent(QPaintEvent* event) override;
    void showEvent(QShowEvent* event) override;
    void hideEvent(QHideEvent* event) override;

private:
    ShowFeed& feed_;
    Throttle due_;
    std::vector<Line> lines_;
};

} // namespace lumorph::studio
