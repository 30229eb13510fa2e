#include "app/studio/calibration/live_service.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include <QPainter>
#include <QStringList>
#include <QTimer>

#include "core/base/clock.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr int kLookMilliseconds = 50;
constexpr double kSeenLately = 1.0;             // seconds
constexpr std::size_t kMostArrivals = 20'000;   // poses, while the window stands still
constexpr int kDotRadius = 5, kRingRadius = 26; // projector pixels

QString joined(const std::vector<PoseRole>& roles) {
    QStringList words;
    for (const PoseRole role : roles) words << wordOf(role);
    return words.join(QObject::tr(" and "));
}

/// A dot to be touched; the ring around it is found from afar.
QImage dotPicture(const glm::ivec2& size, const glm::dvec2& pixel) {
    QImage picture(size.x, size.y, QImage::Format_RGB32);
    picture.fill(Qt::black);
    QPainter painter(&picture);
    painter.setRenderHint(QPainter::Antialiasing);
    const QPointF at(pixel.x + 0.5, pixel.y + 0.5);
    painter.setPen(Qt::NoPen);
    painter.setBrush(Qt::white);
    painter.drawEllipse(at, kDotRadius, kDotRadius);
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(Qt::gray, 2.0));
    painter.drawEllipse(at, kRingRadius, kRingRadius);
    return picture;
}

} // namespace

QString wordOf(PoseRole role) {
    switch (role) {
    case PoseRole::head:
        return QObject::tr("head");
    case PoseRole::device:
        return QObject::tr("device");
    case PoseRole::pointer:
        break;
    }
    return QObject::tr("pointer");
}

/// What the trackers' threads bring until the window's takes it.
struct LiveService::Arrivals {
    struct Seen {
        std::string source, body;
        double seconds = 0.0;
        std::optional<Pose> pose;
    };
    std::mutex mutex;
    std::vector<Seen> seen;

    void add(const std::string& source, const TrackerFrame& frame) {
        const double seconds = 1e-6 * static_cast<double>(frame.measured.count());
        const std::scoped_lock lock(mutex);
        if (seen.size() > kMostArrivals) seen.clear();
        for (const TrackedBody& body : frame.bodies)
            seen.push_back({source, body.name, seconds,
                            body.valid && body.isNumber ? std::optional(body.pose) : std::optional<Pose>()});
    }
    [[nodiscard]] std::vector<Seen> taken() {
        const std::scoped_lock lock(mutex);
        return std::exchange(seen, {});
    }
};

LiveService::LiveService(TrackerService& trackers, Shower show)
    : trackers_(trackers), show_(std::move(show)), arrivals_(std::make_shared<Arrivals>()), timer_(new QTimer(this)) {
    timer_->setInterval(kLookMilliseconds);
    connect(timer_, &QTimer::timeout, this, [this] { follow(); });
}

LiveService::~LiveService() {
    if (tap_ != 0) trackers_.removeTap(tap_);
}

QString LiveService::obstacle(const std::vector<PoseRole>& roles) const {
    const std::vector<SeenBody> bodies = trackers_.bodies();
    std::vector<PoseRole> unseen;
    for (const PoseRole role : roles) {
        const auto seen = [&](const SeenBody& body) { return body.role == role && body.age < kSeenLately; };
        const auto count = std::ranges::count_if(bodies, seen);
        if (count == 0) unseen.push_back(role);
        if (count > 1)
            return tr("Two tracked bodies are the %1: give one of them no role in Devices.").arg(wordOf(role));
    }
    if (unseen.empty()) return {};
    if (trackers_.trackers().empty())
        return tr("No tracker is connected. Open it in Devices, and say there which body is the %1.")
            .arg(joined(unseen));
    return tr("The tracker does not see the %1: bring it into sight, or say in Devices which body it is.")
        .arg(joined(unseen));
}

void LiveService::begin(LivePlan plan, const glm::dvec3& tip, const glm::ivec2& picture) {
    cancel();
    capture_.emplace(std::move(plan), tip);
    picture_ = picture;
    try {
        showDot();
    } catch (...) {
        capture_.reset();
        throw;
    }
    (void)arrivals_->taken();
    sources_.clear();
    tap_ = trackers_.addTap(
        [into = arrivals_](const std::string& source, const TrackerFrame& frame) { into->add(source, frame); });
    stand_ = standOf(*capture_);
    timer_->start();
    emit changed();
}

void LiveService::cancel() {
    if (!capture_) return;
    end();
    emit changed();
}

void LiveService::takeBack() {
    if (!capture_) return;
    capture_->takeBack();
    follow();
}

void LiveService::end() {
    timer_->stop();
    trackers_.removeTap(std::exchange(tap_, 0));
    capture_.reset();
    stand_.reset();
    if (std::exchange(shown_, std::nullopt)) show_(QImage());
}

void LiveService::showDot() {
    const LivePlan& plan = capture_->plan();
    const std::optional<PlannedDot>& wanted = plan.steps.at(capture_->step()).dot;
    if (!wanted || shown_ == wanted->pixel) return;
    show_(dotPicture(picture_, wanted->pixel));
    shown_ = wanted->pixel;
}

void LiveService::follow() {
    if (!capture_) return;
    for (const Arrivals::Seen& seen : arrivals_->taken())
        if (const std::optional<PoseRole> role = trackers_.role(seen.body)) {
            // Where two trackers see a body, poses of both would be of two worlds.
            const std::string& source = sources_.try_emplace(*role, seen.source).first->second;
            if (source == seen.source) capture_->add(*role, seen.seconds, seen.pose);
        }
    if (capture_->isComplete()) {
        const LivePlan plan = capture_->plan();
        const std::vector<LiveTake> takes = capture_->takes();
        const bool isSimulated = std::ranges::any_of(sources_, [this](const auto& followed) {
            const std::string& address = followed.second;
            const auto& all = trackers_.trackers();
            const auto tracker = std::ranges::find(all, address, [](const auto& one) { return one.status.address; });
            return isSimulatedTracker(address, tracker == all.end() ? "" : tracker->status.source);
        });
        end();
        emit finished(plan, takes, isSimulated);
        return;
    }
    LiveStand now = standOf(*capture_);
    try {
        showDot();
    } catch (const Error& error) {
        now.trouble = QString::fromUtf8(error.what());
    }
    if (now == stand_) return;
    stand_ = std::move(now);
    emit changed();
}

LiveStand LiveService::standOf(const LiveCapture& capture) const {
    const LiveStep& step = capture.plan().steps.at(capture.step());
    LiveStand stand{capture.step(), capture.plan().steps.size(), capture.fraction(), step.title, {}, step.corner};
    const QString away = obstacle(capture.plan().roles); // also when nothing arrives at all
    stand.trouble = away.isEmpty() ? QString::fromStdString(capture.trouble()) : away;
    return stand;
}

} // namespace lumorph::studio
