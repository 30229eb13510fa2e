#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <QImage>
#include <QObject>
#include <QSize>

#include "app/studio/base/notices.h"
#include "app/studio/document/studio_loop.h"
#include "app/studio/rendering/light_delay.h"
#include "app/studio/rendering/render_thread.h"
#include "app/studio/rendering/show_request.h"

namespace lumorph::studio {

/// Pictures of the show for all who want some: previews and projector windows. Each frame of the loop is drawn once for
/// all of them, the newest first, and nothing is drawn while nobody looks. Lives in the window's thread.
class ShowFeed : public QObject {
    Q_OBJECT
public:
    ShowFeed(StudioLoop& loop, RenderThread& renderer, Notices& notices, QObject* parent = nullptr);

    /// A number for a new view.
    [[nodiscard]] int add() { return ++views_; }
    /// From now on that view is drawn, until `drop`. Without pixels it is not.
    void want(int id, const ShowView& view, QSize pixels);
    void drop(int id);
    /// Whether some view is drawn.
    [[nodiscard]] bool isWanted() const noexcept { return !wanted_.empty(); }
    /// Draws the newest frame again, for example after a failure.
    void refresh();
    /// Measures each pass by itself; costs a little.
    void setMeasuring(bool on);

    /// The newest picture of a view; null before the first.
    [[nodiscard]] QImage picture(int id) const;
    /// What the newest pictures show: frame, times, resolution. Empty frame before the first.
    [[nodiscard]] const DrawnShow& newest() const noexcept { return newest_; }
    [[nodiscard]] double rate() const;     ///< pictures a second
    [[nodiscard]] double endToEnd() const; ///< milliseconds from the loop's frame to its pictures, the last one
    [[nodiscard]] double usualDelay() const noexcept { return delay_.usual(); } ///< that, of late; 0 before the first
    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }       ///< frames shown so far

signals:
    void shown();         ///< there are new pictures
    void wantedChanged(); ///< `isWanted` may be otherwise now

private:
    struct Wanted {
        ShowView view;
        QSize pixels;
    };
    void sendSoon();
    void send();
    void take();
    void tellFailure(const QString& why);
    void tellWarnings(const std::vector<std::string>& warnings);

    StudioLoop& loop_;
    RenderThread& renderer_;
    Notices& notices_;
    std::map<int, Wanted> wanted_;
    std::map<int, QImage> pictures_;
    DrawnShow newest_;
    std::vector<std::int64_t> shownAt_; ///< milliseconds
    double endToEnd_ = 0.0;
    LightDelay delay_;
    std::uint64_t measured_ = 0; ///< number of the last frame that counts for it, or that nobody wanted
    std::uint64_t count_ = 0;
    std::set<std::string> told_; ///< warnings
    int views_ = 0;
    bool measuring_ = false;
    bool sending_ = false;
};

} // namespace lumorph::studio
