#pragma once

#include <QWidget>

#include "app/studio/shell/studio.h"

class QPushButton;
class QTimer;

namespace lumorph::studio {

/// One command a driver ("drive.target", "drive.sceneItem", "drive.hand", "drive.dance", "drive.recording",
/// "drive.program"), which says his name and is off with a reason where he has nothing to follow; and "drive.back" to
/// whoever moved the servos before.
void addDriverCommands(Studio& studio);

/// For the top bar: says who moves the servos ("bar.driver"), with the commands above in its menu; lights up when
/// somebody takes over, and then has the way back beside it ("bar.driver.back"). The commands must be there.
class DriverChip : public QWidget {
    Q_OBJECT
public:
    DriverChip(Studio& studio, QWidget* parent);
    /// Without words where there is no room: the icon alone.
    void setNarrow(bool narrow);

    [[nodiscard]] bool isNarrow() const noexcept { return narrow_; }
    /// The width that its words take, or would take, pixels.
    [[nodiscard]] int wordsWidth() const noexcept { return wordsWidth_; }

private:
    void refresh();
    void light();

    Studio& studio_;
    bool narrow_ = false;
    int wordsWidth_ = 0;
    QPushButton* chip_ = nullptr;
    QPushButton* back_ = nullptr;
    QTimer* lit_ = nullptr; ///< runs while it is lit
};

} // namespace lumorph::studio
