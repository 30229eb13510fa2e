#include "app/studio/sound/sound_service.h"

namespace lumorph::studio {

SoundService::SoundService(Settings& settings, StudioLoop& loop) : settings_(settings), loop_(loop) {
    connect(&settings_, &Settings::soundChanged, this, &SoundService::follow);
    follow();
    tap_ = loop_.addTap([this](const MatchFrame& frame) { take(frame); });
}

SoundService::~SoundService() { loop_.removeTap(tap_); }

void SoundService::open() {
    auto output = std::make_unique<SoundOutput>(mixer_);
    const std::scoped_lock lock(opening_);
    output_ = std::move(output);
}

void SoundService::follow() {
    mixer_->setOn(settings_.sound());
    mixer_->setLoudness(settings_.loudness());
}

void SoundService::take(const MatchFrame& frame) {
    mixer_->play(frame.sounds);
    if (!frame.sounds.empty()) wake();
}

void SoundService::signal(const char* name) {
    mixer_->signal({name, 1.0, {}});
    wake();
}

void SoundService::wake() {
    if (mixer_->silent()) return;
    const std::scoped_lock lock(opening_);
    if (output_) output_->wake();
}

} // namespace lumorph::studio
