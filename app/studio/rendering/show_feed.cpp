#include "app/studio/rendering/show_feed.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/base/clock.h"

namespace lumorph::studio {
namespace {

constexpr auto kPlace = "viewport";
constexpr std::int64_t kSecond = 1000;

/// Whether a picture answers what is wanted: an observer who moves gets those from where he just was.
bool answers(const ShowView& picture, const ShowView& wanted) {
    return picture.kind == wanted.kind && picture.projector == wanted.projector && picture.bend == wanted.bend &&
           picture.exact == wanted.exact;
}

QString failureSubject() { return ShowFeed::tr("Views of the scene"); }

std::int64_t nowMilliseconds() {
    return std::chrono::duration_cast<std::chrono::milliseconds>(SteadyClock().now()).count();
}

} // namespace

ShowFeed::ShowFeed(StudioLoop& loop, RenderThread& renderer, Notices& notices, QObject* parent)
    : QObject(parent), loop_(loop), renderer_(renderer), notices_(notices) {
    connect(&loop_, &StudioLoop::framed, this, &ShowFeed::send);
    connect(&renderer_, &RenderThread::ready, this, &ShowFeed::sendSoon);
    connect(&renderer_, &RenderThread::showDrawn, this, &ShowFeed::take);
    connect(&renderer_, &RenderThread::showBroke, this, &ShowFeed::tellFailure);
}

void ShowFeed::want(int id, const ShowView& view, QSize pixels) {
    if (pixels.isEmpty()) return drop(id);
    const auto found = wanted_.find(id);
    if (found != wanted_.end() && found->second.view == view && found->second.pixels == pixels) return;
    wanted_.insert_or_assign(id, Wanted{view, pixels});
    sendSoon();
    emit wantedChanged();
}

void ShowFeed::drop(int id) {
    pictures_.erase(id);
    if (wanted_.erase(id) == 0) return;
    sendSoon();
    emit wantedChanged();
}

void ShowFeed::refresh() { sendSoon(); }

void ShowFeed::setMeasuring(bool on) {
    if (std::exchange(measuring_, on) != on) sendSoon();
}

QImage ShowFeed::picture(int id) const {
    const auto found = pictures_.find(id);
    return found == pictures_.end() ? QImage() : found->second;
}

double ShowFeed::rate() const {
    const std::int64_t from = nowMilliseconds() - kSecond;
    return static_cast<double>(
        std::count_if(shownAt_.begin(), shownAt_.end(), [from](std::int64_t at) { return at > from; }));
}

double ShowFeed::endToEnd() const { return endToEnd_; }

/// Several views change at once, when a window changes its size: one request for all.
void ShowFeed::sendSoon() {
    if (std::exchange(sending_, true)) return;
    QMetaObject::invokeMethod(this, &ShowFeed::send, Qt::QueuedConnection);
}

void ShowFeed::send() {
    sending_ = false;
    ShowRequest request;
    request.match = loop_.frame();
    request.measure = measuring_;
    for (const auto& [id, wanted] : wanted_) request.views.push_back({id, wanted.view, wanted.pixels});
    // What nobody wanted when it came is as old as the view for which it is drawn later.
    if (wanted_.empty() && request.match) measured_ = request.match->number;
    renderer_.requestShow(std::move(request));
}

void ShowFeed::take() {
    auto drawn = renderer_.takeShow();
    if (!drawn) return;
    for (const DrawnShow::Picture& picture : drawn->pictures) {
        const auto wanted = wanted_.find(picture.id);
        if (wanted != wanted_.end() && answers(picture.view, wanted->second.view))
            pictures_[picture.id] = picture.image;
    }
    notices_.dismiss(kPlace, failureSubject());
    tellWarnings(drawn->warnings);
    drawn->pictures.clear();
    newest_ = std::move(*drawn);
    const std::int64_t now = nowMilliseconds();
    std::erase_if(shownAt_, [now](std::int64_t at) { return at <= now - kSecond; });
    shownAt_.push_back(now);
    // A frame drawn again in full is as old as its rest; that says nothing about the delay.
    const double age = std::chrono::duration<double, std::milli>(SteadyClock().now() - newest_.match->time).count();
    if (!newest_.still || newest_.resolution < 1.0 || endToEnd_ == 0.0 || 4.0 * age < kSecond) {
        endToEnd_ = age;
        // While the loop rests, frames of long ago are drawn; and shaders compile before the first picture.
        const std::uint64_t number = newest_.match->number;
        if (count_ > 0 && number != measured_) delay_.add(age);
        measured_ = number;
        loop_.setLightDelay(1e-3 * delay_.usual());
    }
    ++count_;
    emit shown();
}

void ShowFeed::tellFailure(const QString& why) {
    Notice notice;
    notice.subject = failureSubject();
    notice.why = tr("They could not be drawn. %1").arg(why);
    notice.actions.push_back({tr("Draw again"), [this] { refresh(); }});
    notices_.post(kPlace, std::move(notice));
}

void ShowFeed::tellWarnings(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) {
        if (!told_.insert(warning).second) continue;
        Notice notice;
        notice.level = Notice::Level::warning;
        notice.subject = tr("Shader");
        notice.why = QString::fromStdString(warning);
        notices_.post(kPlace, std::move(notice));
    }
}

} // namespace lumorph::studio
