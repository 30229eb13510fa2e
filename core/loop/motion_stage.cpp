#include "core/loop/motion_stage.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/loop/viewer_stage.h"
#include "core/motion/rig_motion.h"

namespace lumorph {

namespace {

constexpr double kArrived = 1e-5;   // strokes; a thousandth of a degree
constexpr double kShortStep = 0.05; // seconds; no step so short is a stop
constexpr double kStopsAfter = 2.0; // times the steps before

bool sameActuators(const Rig& a, const Rig& b) {
    return std::ranges::equal(a.actuators(), b.actuators(), {}, &Actuator::name, &Actuator::name);
}

std::optional<std::size_t> placeOf(const Rig& rig, const std::string& actuator) {
    const auto found = std::ranges::find(rig.actuators(), actuator, &Actuator::name);
    if (found == rig.actuators().end()) return std::nullopt;
    return static_cast<std::size_t>(found - rig.actuators().begin());
}

} // namespace

void MotionStage::follow(const std::shared_ptr<const Rig>& rig, const std::shared_ptr<const void>& origin) {
    if (rig == rig_) return;
    const bool edited = rig_ && origin && origin == origin_;
    const bool stay = edited || (rig_ && sameActuators(*rig_, *rig));
    const MotionModel last = std::exchange(motion_, MotionModel(motionLimits(*rig)));
    const std::vector<double> real = std::exchange(real_, std::vector<double>(rig->actuatorCount(), 0.0));
    limits_ = motionLimits(*rig);
    if (stay)
        goOn(last, real, *rig_, *rig);
    else
        delayed_.standAt(real_);
    rig_ = rig;
    origin_ = origin;
    deformed_ = nullptr;
    readServos();
}

void MotionStage::use(const std::shared_ptr<const Installation>& installation, double lightDelay) {
    const double light = installation ? lightAhead(*installation, lightDelay) : 0.0;
    const bool same = installation == installation_ ||
                      (installation && installation_ && installation->servos == installation_->servos);
    const bool sameLight = std::exchange(light_, light) == light;
    installation_ = installation;
    if (!same)
        readServos();
    else if (!sameLight)
        readLags();
}

void MotionStage::readServos() {
    curves_ = installation_ && rig_ ? ServoCurves(rig_->actuators(), installation_->servos) : ServoCurves();
    curves_.follow(commands(), real_);
    readLags();
    look(real_, commands(), 0.0);
}

void MotionStage::readLags() {
    lags_ = installation_ && rig_ ? lagsOf(rig_->actuators(), installation_->servos) : std::vector<double>();
    if (std::ranges::all_of(lags_, [](double lag) { return lag == 0.0; })) lags_.clear();
    std::vector<double> delays;
    for (const double lag : lags_) delays.push_back(std::max(0.0, lag - light_));
    delayed_.setDelays(std::move(delays));
}

/// A command that is given now is where the servo is when the next one comes; the one before is where it is now.
void MotionStage::look(std::span<const double> before, std::span<const double> aims, double seconds) {
    seen_ = real_;
    if (lags_.empty()) return delayed_.standAt(real_);
    delayed_.step(before, seconds);
    std::vector<double> coming(commands().begin(), commands().end()), later = real_;
    const auto aheadOf = [&](std::size_t i) { return light_ - lags_[i] - seconds; };
    for (std::size_t i = 0; i < coming.size(); ++i)
        if (lags_[i] > 0.0 && aheadOf(i) > 0.0)
            coming[i] = advance({coming[i], motion_.velocities()[i]}, aims[i], aheadOf(i), limits_[i]).position;
    curves_.follow(coming, later);
    for (std::size_t i = 0; i < seen_.size(); ++i) {
        if (lags_[i] == 0.0) continue;
        const double reached = light_ - lags_[i];
        seen_[i] = reached <= 0.0       ? delayed_.strokes()[i]
                   : reached >= seconds ? later[i]
                                        : before[i] + reached / seconds * (real_[i] - before[i]);
    }
}

bool MotionStage::stands() const { return lags_.empty() || (delayed_.stand() && seen_ == real_); }

void MotionStage::standAt(std::span<const double> strokes) {
    motion_.reset(strokes);
    real_.assign(strokes.begin(), strokes.end());
    if (!curves_.empty()) motion_.reset(curves_.commandsAt(strokes));
    delayed_.standAt(strokes);
    seen_ = real_;
}

void MotionStage::goOn(const MotionModel& last, const std::vector<double>& real, const Rig& from, const Rig& to) {
    const bool sameCount = from.actuatorCount() == to.actuatorCount();
    std::vector<double> positions(to.actuatorCount(), 0.0), velocities(to.actuatorCount(), 0.0);
    std::vector<std::optional<std::size_t>> places(to.actuatorCount());
    for (std::size_t i = 0; i < to.actuatorCount(); ++i) {
        auto before = placeOf(from, to.actuators()[i].name);
        if (!before && sameCount) before = i;
        places[i] = before;
        if (!before) continue;
        positions[i] = last.positions()[*before];
        velocities[i] = last.velocities()[*before];
        real_[i] = real[*before];
    }
    motion_.resume(positions, velocities);
    delayed_.rearrange(places);
}

void MotionStage::move(std::span<const double> wanted, double sinceLast, bool stopped) {
    const double seconds = moving(sinceLast);
    const std::vector<double> before(motion_.positions().begin(), motion_.positions().end());
    if (stopped) {
        motion_.reset(before); // velocities become zero
        return look(real_, before, seconds);
    }
    const std::vector<double> aims = curves_.commandsFor(wanted, real_, before);
    motion_.step(aims, seconds);
    // The approach has no end; its last, invisible bit is done at once where the limits allow it.
    bool ends = isAt(aims);
    for (std::size_t i = 0; i < before.size() && ends; ++i)
        ends = std::abs(aims[i] - before[i]) <= limits_[i].maxVelocity * seconds;
    if (ends) motion_.reset(aims);
    const std::vector<double> stood = real_;
    curves_.follow(commands(), real_);
    look(stood, aims, seconds);
}

void MotionStage::rest(double seconds) {
    motion_.reset(std::vector<double>(commands().begin(), commands().end())); // velocities become zero
    if (lags_.empty()) return;
    // The last command is done as soon as any, and then nothing happens.
    const double last = std::min(seconds, usual_);
    delayed_.step(real_, last);
    delayed_.step(real_, seconds - last);
}

double MotionStage::moving(double seconds) {
    const double longest = std::max(kStopsAfter * usual_, kShortStep);
    double moving = seconds;
    if (seconds > longest) {
        moving = usual_;
        rest(seconds - moving);
    }
    if (seconds > 0.0) usual_ = std::min(seconds, longest);
    return moving;
}

bool MotionStage::arrived(std::span<const double> wanted) const {
    return isAt(curves_.commandsFor(wanted, real_, commands()));
}

bool MotionStage::isAt(std::span<const double> commands) const noexcept {
    const auto near = [](double a, double b) { return std::abs(a - b) <= kArrived; };
    return std::ranges::equal(motion_.positions(), commands, near);
}

const std::shared_ptr<const std::vector<glm::vec3>>& MotionStage::deformed() {
    if (deformed_ && std::ranges::equal(deformedAt_, strokes())) return deformed_;
    auto positions = std::make_shared<std::vector<glm::vec3>>(rig_->restMesh().positions.size());
    rig_->deform(strokes(), *positions);
    deformedAt_.assign(strokes().begin(), strokes().end());
    deformed_ = std::move(positions);
    return deformed_;
}

} // namespace lumorph
