#include "app/studio/document/studio_loop.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "app/studio/document/match_wish.h"

namespace lumorph::studio {

namespace {

// A frame that fails is not told of, so errors are asked for.
constexpr int kErrorMilliseconds = 200;

std::int64_t nowMilliseconds() {
    return std::chrono::duration_cast<std::chrono::milliseconds>(SteadyClock().now()).count();
}

} // namespace

StudioLoop::StudioLoop(StudioDocument& document, QObject* parent) : QObject(parent), document_(document) {
    thread_ = std::make_unique<MatchThread>([this] {
        tap();
        if (!posted_.exchange(true))
            QMetaObject::invokeMethod(
                this, [this] { take(); }, Qt::QueuedConnection);
    });
    documentDriver_ = document_.state().matching.driver;
    connect(&document_, &StudioDocument::changed, this, &StudioLoop::onChanged);
    connect(&errors_, &QTimer::timeout, this, &StudioLoop::takeError);
    errors_.start(kErrorMilliseconds);
    sendSoon();
}

StudioLoop::~StudioLoop() { thread_.reset(); }

double StudioLoop::rate() const noexcept { return thread_->rate(); }

double StudioLoop::matchRate() const noexcept {
    const std::int64_t since = nowMilliseconds() - 1000;
    return static_cast<double>(
        std::count_if(shownAt_.begin(), shownAt_.end(), [&](std::int64_t at) { return at > since; }));
}

void StudioLoop::stop() {
    emit stopOrdered();
    if (std::exchange(stopped_, true)) return;
    send(); // not a turn of the event loop later
    emit stoppedChanged();
}

void StudioLoop::resume() {
    if (!std::exchange(stopped_, false)) return;
    send();
    emit stoppedChanged();
}

void StudioLoop::setDancing(bool dancing) {
    if (std::exchange(dancing_, dancing) == dancing) return;
    if (dancing) setPosePlay(nullptr);
    sendSoon();
    emit dancingChanged();
    emit driverChanged();
}

void StudioLoop::setPosePlay(std::shared_ptr<const PosePlay> play) {
    if (std::exchange(posePlay_, play) == play) return;
    if (play) setDancing(false);
    sendSoon();
    emit posePlayChanged();
    emit driverChanged();
}

void StudioLoop::seek(double seconds) {
    if (!std::isfinite(seconds)) return;
    seek_ = seconds;
    sendSoon();
}

void StudioLoop::setTint(bool shown) {
    if (std::exchange(tint_, shown) != shown) sendSoon();
}

void StudioLoop::setScenePlaying(bool playing) {
    if (std::exchange(scenePlaying_, playing) == playing) return;
    sendSoon();
    emit scenePlayingChanged();
}

void StudioLoop::seekScene(double seconds) {
    if (!std::isfinite(seconds)) return;
    sceneSeek_ = seconds;
    sendSoon();
}

void StudioLoop::setPoses(std::shared_ptr<const PoseBoard> poses) {
    poses_ = std::move(poses);
    sendSoon();
}

void StudioLoop::setLightDelay(double seconds) {
    constexpr double kStep = 0.005; // what is predicted shall not tremble with the delay
    if (!std::isfinite(seconds) || std::abs(seconds - lightDelay_) < kStep) return;
    lightDelay_ = seconds;
    if (poses_) sendSoon();
}

void StudioLoop::setRate(double framesPerSecond) {
    if (std::isfinite(framesPerSecond)) thread_->setRate(std::clamp(framesPerSecond, 1.0, 1000.0));
}

void StudioLoop::setPaused(bool paused) {
    if (std::exchange(paused_, paused) != paused) thread_->setPaused(paused);
}

void StudioLoop::setSource(std::shared_ptr<FrameSource> source) {
    source_ = std::move(source);
    if (source_) setPosePlay(nullptr);
    send();
    emit driverChanged();
}

Driver StudioLoop::driver() const noexcept {
    if (source_) return Driver::recording;
    if (dancing_) return Driver::dance;
    if (posePlay_) return Driver::hand;
    return program_ && programDrives_ ? Driver::program : document_.state().matching.driver;
}

void StudioLoop::setProgram(std::shared_ptr<ShowProgram> program) {
    if (program_ == program) return;
    program_ = std::move(program);
    inputs_ = program_ ? std::make_shared<ShowInputs>() : nullptr;
    programDrives_ = program_ != nullptr;
    if (programDrives_) {
        setDancing(false);
        setPosePlay(nullptr);
    }
    send(); // not a turn of the event loop later: frames that begin from now on are of this program
    programSince_ = SteadyClock().now();
    emit driverChanged();
}

void StudioLoop::setProgramDrives(bool drives) {
    programDrives_ = drives && program_;
    if (programDrives_) {
        setDancing(false);
        setPosePlay(nullptr);
    }
    sendSoon();
    emit driverChanged();
}

void StudioLoop::input(const std::string& name, double value) {
    if (!inputs_ || !std::isfinite(value)) return;
    inputs_->push({name, value});
    sendSoon(); // a loop that rests looks at it now
    emit inputGiven(QString::fromStdString(name), value);
}

void StudioLoop::setLanguage(Language language) {
    if (std::exchange(language_, language) != language) sendSoon();
}

void StudioLoop::refresh() { sendSoon(); }

int StudioLoop::addTap(Tap tap) {
    const std::scoped_lock lock(tapping_);
    taps_.emplace(nextTap_, std::move(tap));
    return nextTap_++;
}

void StudioLoop::removeTap(int id) {
    const std::scoped_lock lock(tapping_);
    taps_.erase(id);
}

void StudioLoop::tap() {
    const std::scoped_lock lock(tapping_);
    const auto frame = taps_.empty() ? nullptr : thread_->latest();
    if (!frame) return;
    for (const auto& [id, tap] : taps_) tap(*frame);
}

void StudioLoop::onChanged(StateParts parts) {
    // Whoever takes the servos in the document ends what moves them for the moment.
    const Driver before = std::exchange(documentDriver_, document_.state().matching.driver);
    const bool newTarget = (parts & StatePart::target) && document_.state().target.target;
    const bool taken = before != documentDriver_ || newTarget || (parts & StatePart::strokes);
    const bool otherActuators =
        posePlay_ && document_.state().rig.rig && document_.state().rig.rig->actuatorCount() != posePlay_->from.size();
    if (taken || (parts & StatePart::rig)) setDancing(false);
    if (taken || (parts & StatePart::rig) || otherActuators) setPosePlay(nullptr);
    if (taken) {
        programDrives_ = false;
        if (!(parts & StatePart::rig)) emit this->taken();
        emit driverChanged();
    }
    if (parts & StatePart::target || document_.state().playback.playing) seek_.reset();
    sendSoon();
}

void StudioLoop::sendSoon() {
    if (std::exchange(sending_, true)) return;
    QMetaObject::invokeMethod(this, &StudioLoop::send, Qt::QueuedConnection);
}

void StudioLoop::send() {
    sending_ = false;
    if (!document_.state().rig.rig) return;
    MatchWish wish = wishOf(document_.state());
    wish.program = program_;
    wish.inputs = inputs_;
    wish.driver = driver();
    wish.posePlay = posePlay_;
    wish.stopped = stopped_;
    wish.seek = seek_;
    wish.showTint = tint_;
    wish.poses = source_ ? nullptr : poses_;
    wish.source = source_;
    wish.lightDelay = lightDelay_;
    wish.language = language_;
    wish.scenePlaying = scenePlaying_;
    wish.sceneSeek = sceneSeek_;
    thread_->wish(std::move(wish));
}

void StudioLoop::takeError() {
    if (const auto error = thread_->takeError()) emit failed(QString::fromStdString(*error));
}

void StudioLoop::take() {
    posted_ = false;
    std::shared_ptr<const MatchFrame> latest = thread_->latest();
    if (!latest || latest == frame_) return;
    frame_ = std::move(latest);
    if (frame_->matched) {
        const std::int64_t now = nowMilliseconds();
        std::erase_if(shownAt_, [&](std::int64_t at) { return at <= now - 1000; });
        shownAt_.push_back(now);
    }
    if (program_ && frame_->time >= programSince_ && !frame_->programError.empty()) {
        setProgram(nullptr);
        emit failed(QString::fromStdString(frame_->programError));
    }
    emit framed();
}

} // namespace lumorph::studio
