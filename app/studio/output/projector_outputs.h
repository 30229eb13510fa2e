#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include <QMenu>
#include <QObject>
#include <QPointer>
#include <QScreen>

#include "app/studio/base/notices.h"
#include "app/studio/document/studio_document.h"
#include "app/studio/output/projector_window.h"

namespace lumorph::studio {

/// The windows of all projectors: where each is shown, test patterns, and what happens when a screen goes. Tells its
/// notices at the place "output". Lives in the window's thread.
class ProjectorOutputs : public QObject {
    Q_OBJECT
public:
    ProjectorOutputs(StudioDocument& document, ShowFeed& feed, Commands& commands, Notices& notices,
                     QObject* parent = nullptr);
    ~ProjectorOutputs() override;

    /// Projectors count from 0; one that the scene does not have is ignored.
    void showInWindow(std::size_t projector);
    /// Covers a screen, by its name. Where the studio itself is in sight there, it asks first, by a notice.
    void showOnScreen(std::size_t projector, const QString& screen);
    /// The projector is the one at this screen: as `showOnScreen`, and unless its lens was measured it is taken to have
    /// the screen's pixels, which is a step of undo.
    void useScreen(std::size_t projector, const QString& screen);
    /// That a projector covers; empty: none.
    [[nodiscard]] QString screenOf(std::size_t projector) const;
    /// The first screen on which neither the studio nor a projector is; empty: none.
    [[nodiscard]] QString freeScreen() const;
    [[nodiscard]] static QSize pixelsOf(const QScreen& screen);
    void close(std::size_t projector);
    void closeAll();
    void identify(); ///< every open output shows its number
    void setPattern(TestPattern pattern);
    [[nodiscard]] TestPattern pattern() const noexcept { return pattern_; }
    void setScaled(bool on);

    /// Null while it is not shown.
    [[nodiscard]] ProjectorWindow* window(std::size_t projector) const;
    /// Whatever can be done, for a menu.
    void fillMenu(QMenu& menu);

    /// A screen was unplugged: what covered it becomes a window. Connected to the application; tests call it.
    void screenGone(const QString& name);

signals:
    void changed();

private:
    struct Output {
        std::unique_ptr<ProjectorWindow> window;
        QString screen; ///< that it covers; empty: none
    };
    [[nodiscard]] std::size_t count() const;
    Output& open(std::size_t projector);
    void cover(std::size_t projector, const QString& screen);
    void ask(std::size_t projector, const QString& screen);
    void askBack(std::size_t projector, const QString& screen);
    void heedSize(std::size_t projector);
    void onInstallationChanged();
    void addCommands();
    void addScreenCommands();
    QAction* add(const QString& id, const QString& text, std::function<void()> run, bool checkable = false);

    StudioDocument& document_;
    ShowFeed& feed_;
    Commands& commands_;
    Notices& notices_;
    std::map<std::size_t, Output> outputs_;
    std::vector<QPointer<ProjectorWindow>> closing_; ///< deleted when the event loop comes round
    std::set<QString> allowed_;                      ///< screens of the studio that may be covered
    TestPattern pattern_ = TestPattern::none;
    bool scaled_ = false;
};

} // namespace lumorph::studio
