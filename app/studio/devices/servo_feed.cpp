#include "app/studio/devices/servo_feed.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lumorph::studio {

template <class Order> void ServoFeed::eachLeaving(Order order) {
    for (const auto& one : leaving_)
        if (const auto link = one.lock()) order(link);
}

void ServoFeed::attach(std::shared_ptr<ServoLink> link, std::size_t servos) {
    const std::scoped_lock lock(mutex_);
    std::erase_if(leaving_, [](const auto& one) { return one.expired(); });
    if (link_) leaving_.push_back(link_);
    link_ = std::move(link);
    holds_.assign(servos, std::nullopt);
    stoppedLive_ = false;
    heldServos_.forget();
    slow(SlowCause::held, false);
    if (link_) link_->setSlow(causes_ != 0);
    tell();
}

void ServoFeed::setSlow(SlowCause cause, bool on) {
    const std::scoped_lock lock(mutex_);
    slow(cause, on);
}

void ServoFeed::slow(SlowCause cause, bool on) {
    const bool before = causes_ != 0;
    const unsigned bit = 1U << static_cast<unsigned>(cause);
    causes_ = on ? causes_ | bit : causes_ & ~bit;
    if ((causes_ != 0) == before) return;
    if (link_) link_->setSlow(!before);
    // What leaves is not hurried: nobody looks any more whether its servos are held.
    if (!before) eachLeaving([](const auto& link) { link->setSlow(true); });
}

void ServoFeed::checkHands(Microseconds now) {
    // It is called in the link's thread, which must not wait for a busy one that holds this: there is a next time.
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || !link_) return;
    heldServos_.look(link_->status(), now);
    slow(SlowCause::held, !heldServos_.held().empty());
}

std::vector<std::size_t> ServoFeed::stuck() const {
    const std::scoped_lock lock(mutex_);
    return heldServos_.held();
}

void ServoFeed::stop() {
    const std::scoped_lock lock(mutex_);
    const LinkPhase before = link_ ? link_->status().phase : LinkPhase::off;
    if (link_) link_->stop();
    eachLeaving([](const auto& link) { link->stop(); });
    stoppedLive_ = stoppedLive_ || before == LinkPhase::live || before == LinkPhase::starting;
    holds_.assign(holds_.size(), std::nullopt);
}

bool ServoFeed::letGo(std::chrono::milliseconds atMost) {
    const auto end = std::chrono::steady_clock::now() + atMost;
    stop();
    std::vector<std::shared_ptr<ServoLink>> links;
    {
        const std::scoped_lock lock(mutex_);
        if (link_) links.push_back(link_);
        eachLeaving([&links](const auto& link) { links.push_back(link); });
    }
    bool free = true;
    for (const auto& link : links)
        free =
            link->letGo(std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now())) && free;
    return free;
}

bool ServoFeed::takeStoppedLive() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(stoppedLive_, false);
}

void ServoFeed::follow(std::span<const double> strokes, bool anew) {
    const std::scoped_lock lock(mutex_);
    show_.assign(strokes.begin(), strokes.end());
    const LinkPhase phase = anew && link_ ? link_->status().phase : LinkPhase::off;
    if ((phase == LinkPhase::live || phase == LinkPhase::starting) && told_.size() == holds_.size())
        for (std::size_t k = 0; k < holds_.size(); ++k)
            if (!holds_[k]) holds_[k] = Hold{told_[k], {}};
    tell();
}

std::vector<double> ServoFeed::shown() const {
    const std::scoped_lock lock(mutex_);
    return show_;
}

void ServoFeed::hold(std::size_t servo, double stroke) {
    const std::scoped_lock lock(mutex_);
    if (servo >= holds_.size() || servo >= told_.size() || !std::isfinite(stroke)) return;
    if (!holds_[servo]) holds_[servo] = Hold{told_[servo], {}};
    holds_[servo]->aim = std::clamp(stroke, 0.0, 1.0);
}

void ServoFeed::release() {
    const std::scoped_lock lock(mutex_);
    for (auto& hold : holds_)
        if (hold) hold->aim.reset();
}

void ServoFeed::drop() {
    const std::scoped_lock lock(mutex_);
    holds_.assign(holds_.size(), std::nullopt);
    tell();
}

std::optional<double> ServoFeed::held(std::size_t servo) const {
    const std::scoped_lock lock(mutex_);
    return servo < holds_.size() && holds_[servo] ? holds_[servo]->aim : std::nullopt;
}

bool ServoFeed::testing() const {
    const std::scoped_lock lock(mutex_);
    return std::any_of(holds_.begin(), holds_.end(), [](const auto& hold) { return hold.has_value(); });
}

bool ServoFeed::moving() const {
    const std::scoped_lock lock(mutex_);
    return std::any_of(holds_.begin(), holds_.end(),
                       [](const auto& hold) { return hold && (!hold->aim || hold->now != *hold->aim); });
}

void ServoFeed::advance(double seconds) {
    const std::scoped_lock lock(mutex_);
    const double step = kTestVelocity * std::clamp(seconds, 0.0, 0.1);
    for (std::size_t k = 0; k < holds_.size() && k < show_.size(); ++k) {
        auto& hold = holds_[k];
        if (!hold) continue;
        const double aim = hold->aim.value_or(show_[k]);
        hold->now += std::clamp(aim - hold->now, -step, step);
        if (!hold->aim && hold->now == aim) hold.reset();
    }
    tell();
}

void ServoFeed::tell() {
    if (!link_ || show_.empty() || show_.size() != holds_.size()) return;
    told_ = show_;
    for (std::size_t k = 0; k < told_.size(); ++k)
        if (holds_[k]) told_[k] = holds_[k]->now;
    link_->command(told_);
}

} // namespace lumorph::studio
