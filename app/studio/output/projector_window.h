#pragma once

#include <cstddef>

#include <QImage>
#include <QTimer>
#include <QWidget>

#include "app/studio/base/commands.h"
#include "app/studio/output/test_pattern.h"
#include "app/studio/rendering/show_feed.h"

namespace lumorph::studio {

/// What a projector sends out, in a window or on a whole screen. One pixel of the picture is one pixel of the screen at
/// any desktop scale; where sizes differ the picture is centred and cut, and scaled only on request. Painting copies a
/// finished picture, so the window's thread never waits. All commands of the studio work while it has the keyboard.
class ProjectorWindow : public QWidget {
    Q_OBJECT
public:
    /// `number` counts from 0. `feed` and `commands` outlive it.
    ProjectorWindow(ShowFeed& feed, Commands& commands, std::size_t number);
    ~ProjectorWindow() override;

    [[nodiscard]] std::size_t number() const noexcept { return number_; }
    /// Pixels and name of the projector; an empty size: there is no such projector, and it stays black.
    void setProjector(const QString& name, QSize size);
    [[nodiscard]] QSize projectorSize() const noexcept { return size_; }
    void setPattern(TestPattern pattern);
    void setScaled(bool on);
    /// Shows its number for a while.
    void identify(int milliseconds = 3000);
    /// Shows a picture of a calibration in place of all else, pixel by pixel whatever `setScaled` says; a null one
    /// takes it away. `calibrationShown` tells `ticket` when it has reached the screen.
    void setCalibrationPicture(const QImage& picture, quint64 ticket);
    /// Why a calibration's picture would not be on the screen pixel by pixel, with what to do; empty where it would.
    [[nodiscard]] QString calibrationProblem() const;
    /// What it shows now, in the projector's pixels; null before the first picture of the scene.
    [[nodiscard]] QImage picture() const;

    /// On all of a screen; the picture may have another size.
    void coverScreen(QScreen* screen);
    void leaveScreen(); ///< becomes a window again
    /// Pixels of the screen that it covers.
    [[nodiscard]] QSize pixels() const;

signals:
    void closed();
    void calibrationShown(quint64 ticket);
    void covered(); ///< a screen as a whole, with its size known
    void leftScreen();

protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void closeEvent(QCloseEvent* event) override;
    void changeEvent(QEvent* event) override;

private:
    void showTitle();
    void ask(); ///< for pictures, unless it is minimised or shows those of a calibration
    void tellShown(quint64 ticket);

    ShowFeed& feed_;
    const std::size_t number_;
    const int id_;
    QString name_;
    QSize size_;
    TestPattern pattern_ = TestPattern::none;
    QImage patternPicture_;
    QImage calibrationPicture_;
    quint64 ticket_ = 0; ///< of the calibration's picture; 0: it was told
    bool scaled_ = false;
    QTimer identifying_;
};

} // namespace lumorph::studio
