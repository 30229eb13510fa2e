#pragma once

#include <QElapsedTimer>
#include <QMainWindow>
#include <QPointer>

#include "app/studio/shell/application_turn.h"
#include "app/studio/shell/applications_page.h"
#include "app/studio/shell/rest_page.h"
#include "app/studio/shell/studio.h"
#include "app/studio/shell/visitor_bar.h"
#include "app/studio/shell/visitor_layer.h"
#include "app/studio/shell/visitor_watch.h"

class QKeyEvent;

namespace lumorph::studio {

/// What stands between applications and their visitors in the window: the cards to choose from, the keys and buttons
/// that all share, hints and help over the view, and the next application when nobody comes, or when one cannot be
/// shown. Where none can, a quiet page lies over the view until one can again.
class VisitorDesk : public QObject {
    Q_OBJECT
public:
    /// Who has the window: the host at work, or visitors before a view that fills it, whose doors are open or shut.
    enum class Mode { studio, full, kiosk };

    /// `stage` is where the views are. All outlive it.
    VisitorDesk(Studio& studio, QMainWindow& window, QWidget& stage, const Clock& clock);

    [[nodiscard]] Mode mode() const noexcept { return mode_; }
    void setMode(Mode mode);
    void showCards();
    void hideCards();
    /// A page lies over all views: the cards, or the quiet page of a kiosk that can show nothing.
    [[nodiscard]] bool covers() const;
    /// Whether the views are seen: hints over them move only then.
    void setSeen(bool seen) { layer_->setSeen(seen); }
    /// Esc, once: help goes, else the cards come or go.
    void escape();
    /// The keys that ask for help over a view that shows an application. True: taken.
    bool takeKey(const QObject& watched, const QKeyEvent& event);
    /// Whether visitors may do that though the doors are shut. A host's own show has nothing to choose and to play.
    [[nodiscard]] bool mayHave(const QObject& watched, const QEvent& event) const;

signals:
    /// Of the cards, or because nobody came, or because another could not be shown.
    void applicationWanted(const lumorph::Demo& demo);
    void studioWanted();
    void tourWanted();
    void coversChanged();

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void takeOpened();
    void follow();
    void followBar();
    void setResting(bool rests);
    void arrange();
    void giveKeyboard();
    void goOnWhereNobodyPlays();
    void wantApplication(const Demo& demo);
    void followOpening();
    void takeFailure(const QString& name, const Notice& why);
    void takeEnd(const QString& why);
    void leaveOut(const Demo& demo, const Notice& why);
    void goOn();
    void askAgain();
    [[nodiscard]] bool offers() const;
    [[nodiscard]] bool otherSheetOpen() const;

    Studio& studio_;
    QMainWindow& window_;
    QWidget& stage_;
    const Clock& clock_;
    Mode mode_ = Mode::studio;
    ApplicationTurn turn_;
    VisitorWatch watch_;
    VisitorLayer* layer_;
    VisitorBar* bar_;
    RestPage* rest_;
    QPointer<ApplicationsPage> cards_;
    const Demo* opening_ = nullptr; ///< that was wanted last, until it is there
    QElapsedTimer openingSince_;
    bool chosen_ = false;       ///< somebody chose what is being opened; else its turn has come
    bool broken_ = false;       ///< what should show does not
    bool played_ = false;       ///< what was opened last answers visitors
    Microseconds askedLast_{0}; ///< while nothing can be shown
};

} // namespace lumorph::studio
