#pragma once

#include <memory>
#include <optional>

#include <QElapsedTimer>
#include <QTimer>
#include <QWidget>

#include "app/studio/shell/studio.h"

namespace lumorph::studio {

/// What is drawn for visitors over the view of an application: how to play it, small while it begins and whole when
/// somebody asks; a hand that taps while nobody plays; and what the application lets be read. The pointer goes through
/// it.
class VisitorLayer : public QWidget {
    Q_OBJECT
public:
    /// `studio` outlives it.
    VisitorLayer(Studio& studio, QWidget* parent);

    /// Visitors stand before the view: all is shown; else only the help, when somebody asks.
    void setForVisitors(bool on);
    /// An application begins: its ways to play appear for some seconds.
    void begin();
    /// Covers what showed before while an application is opened. `fraction`: the share that is done, negative where it
    /// is unknown.
    void setOpening(const Words& title, double fraction);
    /// It is there, or could not be opened.
    void endOpening();
    [[nodiscard]] bool openingShown() const noexcept { return opening_.has_value(); }
    /// Somebody plays, or nobody does.
    void setPlayed(bool played);
    void setHelp(bool on);
    /// Whether the view below is seen; what moves stands still while not.
    void setSeen(bool seen);
    [[nodiscard]] bool helpShown() const noexcept { return help_; }
    /// The hand taps: the application shows, and nobody plays.
    [[nodiscard]] bool handShown() const;
    /// The ways to play are in sight, small.
    [[nodiscard]] bool waysShown() const;
    /// What can be read now; empty: nothing.
    [[nodiscard]] QString captionTitle() const;
    [[nodiscard]] QString captionSentence() const;

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    void takeFrame();
    void animate();
    [[nodiscard]] double turn(double seconds) const;
    [[nodiscard]] QRect animated() const;
    [[nodiscard]] QRectF waysBox() const;
    [[nodiscard]] QRectF handBox() const;
    [[nodiscard]] QRectF helpBox() const;
    void paintWays(QPainter& painter) const;
    void paintHand(QPainter& painter) const;
    void paintCaption(QPainter& painter) const;
    void paintHelp(QPainter& painter) const;
    void paintOpening(QPainter& painter) const;

    /// What is being opened.
    struct Opening {
        Words title;
        double fraction = 0.0;
    };

    Studio& studio_;
    std::optional<Opening> opening_;
    std::shared_ptr<const ShowCaption> caption_;
    QElapsedTimer since_;   ///< it is there: what moves goes by it
    QElapsedTimer begun_;   ///< since the application began; invalid: long ago
    QElapsedTimer helped_;  ///< since help was asked for
    bool hasSteps_ = false; ///< of which number keys choose one
    bool compares_ = false; ///< with and without, by a key
    QTimer animation_;
    bool forVisitors_ = false;
    bool played_ = false;
    bool help_ = false;
};

} // namespace lumorph::studio
