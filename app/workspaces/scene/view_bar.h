#pragma once

#include <QLabel>
#include <QToolButton>
#include <QWidget>

#include "app/studio/shell/studio.h"
#include "app/workspaces/scene/view_layout.h"

namespace lumorph::studio {

/// The commands of the scene's stage and the strip of buttons above its pictures: which of them are in sight, time,
/// comparison, another point of view, latency, projector outputs.
class ViewBar : public QWidget {
    Q_OBJECT
public:
    /// `studio` outlives it. Its commands are added to the studio's; `scene.play` is there before.
    explicit ViewBar(Studio& studio, QWidget* parent = nullptr);

    [[nodiscard]] StageMode mode() const noexcept { return mode_; }
    void setMode(StageMode mode);
    [[nodiscard]] bool elsewhere() const;
    void setElsewhere(bool on);
    [[nodiscard]] bool latencyShown() const;
    /// Time of the scene.
    void setSeconds(double seconds);

signals:
    void modeChanged();
    void elsewhereChanged();
    void latencyChanged();
    void nextProjector();

protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

private:
    /// Words stand beside the icons as long as there is room: first that of the chosen view alone is left, then none.
    void fitWords();
    void addModes();
    void addToggles();
    QAction* add(const QString& id, const QString& text, const QString& icon, const QString& tip, bool checkable,
                 const QString& shortcut = {});

    Studio& studio_;
    StageMode mode_ = StageMode::pair;
    std::vector<std::pair<StageMode, QAction*>> modes_;
    QAction* elsewhere_ = nullptr;
    QAction* latency_ = nullptr;
    QLabel* time_ = nullptr;
    std::vector<QToolButton*> worded_; ///< buttons with a word beside their icon
};

} // namespace lumorph::studio
