#pragma once

#include <exception>
#include <functional>
#include <vector>

#include <QObject>
#include <QString>

namespace lumorph::studio {

/// Something to tell the user where its cause is: not a modal box.
struct Notice {
    enum class Level { info, warning, error };
    struct Action {
        QString text; ///< of the button: the remedy, as a verb
        std::function<void()> run;
    };
    Level level = Level::error;
    QString subject; ///< what it is about: a file, an actuator
    QString why;
    QString remedy;
    std::vector<Action> actions; ///< buttons; each also dismisses the notice
};

/// A notice that says what an exception says (Error: subject, why, remedy; anything else: its text).
[[nodiscard]] Notice noticeOf(const std::exception& error);

/// Notices by place: "viewport", "rig", "field", "target", "match", "export", "project", "visitors",
/// "home" (other studios, kept work). A place shows its newest; the status line counts all. Lives in the window's
/// thread.
class Notices : public QObject {
    Q_OBJECT
public:
    using QObject::QObject;

    /// Replaces the notice of that place that is about the same subject, if there is one.
    void post(const QString& place, Notice notice);
    void dismiss(const QString& place, const QString& subject);
    /// Of one place; of all when empty.
    void dismissAll(const QString& place = {});
    /// Of one place, newest first; all places when empty.
    [[nodiscard]] std::vector<Notice> at(const QString& place = {}) const;

signals:
    void changed(const QString& place);
    /// The newest of `at(place)` is new.
    void posted(const QString& place);

private:
    struct Entry {
        QString place;
        Notice notice;
    };
    std::vector<Entry> entries_;
};

} // namespace lumorph::studio
