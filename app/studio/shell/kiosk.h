#pragma once

#include <functional>
#include <utility>
#include <vector>

#include <QPointer>

#include "app/studio/base/operator_pin.h"
#include "app/studio/shell/overlay.h"

namespace lumorph::studio {

/// Whether it is that object or below it, over the edges of windows: a menu belongs to what opened it.
[[nodiscard]] bool belongsTo(const QObject* object, const QObject* ancestor);

/// The doors of a window that visitors stand before. While they are closed, the whole program hears no key, pointer,
/// touch or dropped file, but for STOP, Esc (twice: STOP), what an application has for visitors, and the pad for the
/// operator's PIN, which opens what only the operator may do. Whatever a widget would do with its input, it does not
/// get any: nothing needs to know of a kiosk to be shut by it.
class Kiosk : public QObject {
    Q_OBJECT
public:
    /// All outlive it. `stop`, `resume` and `leave` are buttons of the window; the first is for anyone, the others are
    /// the operator's.
    struct Buttons {
        QWidget* stop = nullptr;
        QWidget* resume = nullptr;
        QWidget* leave = nullptr;
    };
    Kiosk(QWidget& window, Settings& settings, const Clock& clock, const Buttons& buttons);
    ~Kiosk() override;

    [[nodiscard]] bool closed() const noexcept { return closed_; }
    /// Runs `chosen` once there is a PIN: at once, or after the operator has chosen one.
    void requirePin(bool mayCancel, std::function<void()> chosen);
    /// Lets the operator choose another PIN.
    void changePin();
    /// Shuts all dialogs and menus, and the doors.
    void close();
    void open();
    /// What visitors may do beside: asked for each input of a widget.
    void setVisitors(std::function<bool(const QObject& watched, const QEvent& event)> mayHave) {
        visitorsMayHave_ = std::move(mayHave);
    }
    /// Runs `run` after the right PIN; at once where the doors are open, or the PIN was forgotten by --forget-pin.
    void askOperator(const QString& why, std::function<void()> run);

signals:
    /// The operator wants to get out, and may.
    void leaveWanted();

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    [[nodiscard]] bool mayHave(const QObject& watched) const;
    void shutWindows();
    void letResume();
    [[nodiscard]] bool padOpen() const;
    void knock(QWidget& door);

    QWidget& window_;
    const Clock& clock_;
    OperatorPin pin_;
    Buttons buttons_;
    std::function<bool(const QObject&, const QEvent&)> visitorsMayHave_;
    QPointer<Overlay> pad_;
    QPointer<QWidget> pressed_;              ///< the operator's button that is held down
    std::vector<QPointer<QWidget>> trusted_; ///< questions that came of what the operator did
    Microseconds trustUntil_{0};             ///< the operator stands before the window
    bool closed_ = false;
};

} // namespace lumorph::studio
