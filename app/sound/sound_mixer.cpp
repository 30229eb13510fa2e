#include "app/sound/sound_mixer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace lumorph {
namespace {

constexpr double kFadeIn = 0.06, kFadeOut = 0.18; ///< seconds, of a sound that goes on
constexpr double kMasterFade = 0.04;              ///< seconds, of on, off and loudness
constexpr double kRelease = 0.25;                 ///< seconds in which the limiter opens from shut
constexpr std::size_t kMostWaiting = SoundMixer::kMostVoices;

float loudest(const std::array<float, 2 * SoundMixer::kChunk>& chunk) {
    float most = 0.0F;
    for (const float sample : chunk) most = std::max(most, std::abs(sample));
    return most;
}

float moved(float from, float to, float most) { return from + std::clamp(to - from, -most, most); }

} // namespace

void SoundMixer::setBoard(std::shared_ptr<const SoundBoard> board) {
    const std::scoped_lock lock(mutex_);
    board_ = std::move(board);
}

void SoundMixer::setRate(int rate) {
    const std::scoped_lock lock(mutex_);
    rate_ = std::max(8'000, rate);
}

void SoundMixer::setOn(bool on) {
    const std::scoped_lock lock(mutex_);
    on_ = on;
    if (on_) return;
    waiting_.clear();
    signals_.clear();
    going_.clear();
}

void SoundMixer::setLoudness(double share) {
    const std::scoped_lock lock(mutex_);
    loudness_ = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
}

void SoundMixer::play(std::span<const ShowSound> sounds) {
    const std::scoped_lock lock(mutex_);
    fresh_ = true;
    going_.clear();
    if (!on_ || !board_) return;
    for (const ShowSound& sound : sounds) {
        const SoundVoice* voice = board_->find(sound.name);
        if (!voice || !(sound.strength >= 0.0)) continue;
        if (voice->continuous)
            going_.push_back(sound);
        else if (waiting_.size() < kMostWaiting)
            waiting_.push_back(sound);
    }
}

void SoundMixer::signal(const ShowSound& sound) {
    const std::scoped_lock lock(mutex_);
    const SoundVoice* voice = on_ && board_ ? board_->find(sound.name) : nullptr;
    if (voice && !voice->continuous && signals_.size() < kMostWaiting) signals_.push_back(sound);
}

void SoundMixer::forget() {
    const std::scoped_lock lock(mutex_);
    waiting_.clear();
    signals_.clear();
}

void SoundMixer::forgetFrames() {
    const std::scoped_lock lock(mutex_);
    waiting_.clear();
}

bool SoundMixer::silent() const {
    const std::scoped_lock lock(mutex_);
    return quiet_ && waiting_.empty() && signals_.empty() && (going_.empty() || !fresh_);
}

void SoundMixer::mix(std::span<std::int16_t> samples) {
    takeNews();
    constexpr auto kLargest = static_cast<float>(std::numeric_limits<std::int16_t>::max());
    for (std::int16_t& sample : samples) {
        if (used_ == ready_.size()) nextChunk();
        sample = static_cast<std::int16_t>(std::lround(kLargest * ready_[used_++]));
    }
    const bool quiet = heard_.empty() && loudest(ahead_) == 0.0F && loudest(ready_) == 0.0F;
    const std::scoped_lock lock(mutex_);
    quiet_ = quiet;
}

void SoundMixer::takeNews() {
    std::vector<ShowSound> once, going;
    bool fresh = false;
    {
        const std::scoped_lock lock(mutex_);
        if (playing_ != board_) heard_.clear(); // they point into it
        playing_ = board_;
        once = std::exchange(waiting_, {});
        for (const ShowSound& sound : std::exchange(signals_, {})) once.push_back(sound);
        fresh = std::exchange(fresh_, false);
        if (fresh) going = going_;
        pace_ = kSoundRate / rate_;
        masterWanted_ = on_ ? static_cast<float>(loudness_ * loudness_) : 0.0F;
    }
    if (!playing_) return;
    if (fresh) {
        sinceFrame_ = 0.0;
        goOn(going);
    }
    for (const ShowSound& sound : once)
        if (const SoundVoice* voice = playing_->find(sound.name)) (void)begin(*voice, sound);
}

/// Left and right by equal power; a little of each side is always heard on the other.
std::array<float, 2> SoundMixer::gainsOf(const SoundVoice& voice, const ShowSound& sound) {
    constexpr double kAside = 0.85;
    const double x = std::isfinite(sound.place.x) ? static_cast<double>(sound.place.x) : 0.0;
    const double pan = kAside * std::clamp(x / kReach, -1.0, 1.0);
    const double angle = 0.25 * std::numbers::pi * (1.0 + pan);
    const double loudness = voice.loudness(sound.strength);
    return {static_cast<float>(loudness * std::cos(angle)), static_cast<float>(loudness * std::sin(angle))};
}

SoundMixer::Heard& SoundMixer::begin(const SoundVoice& voice, const ShowSound& sound) {
    Heard heard;
    heard.voice = &voice;
    heard.speed = voice.speed(sound.strength);
    heard.wanted = gainsOf(voice, sound);
    if (!voice.continuous) heard.gain = heard.wanted;
    if (heard_.size() < kMostVoices) return heard_.emplace_back(heard);
    // The quietest makes room, and of these the one that is nearest to its end.
    const auto remains = [](const Heard& one) {
        const double left = one.voice->continuous ? 1.0 : 1.0 - one.at / static_cast<double>(one.voice->samples.size());
        return static_cast<double>(one.gain[0] + one.gain[1]) * left;
    };
    return *std::ranges::min_element(heard_, {}, remains) = heard;
}

void SoundMixer::goOn(std::span<const ShowSound> sounds) {
    for (Heard& heard : heard_) {
        if (!heard.voice->continuous) continue;
        heard.named = false;
        heard.wanted = {};
    }
    for (const ShowSound& sound : sounds) {
        const SoundVoice* voice = playing_->find(sound.name);
        if (!voice) continue;
        // Those of one name stay in their order from frame to frame.
        const auto known =
            std::ranges::find_if(heard_, [voice](const Heard& one) { return one.voice == voice && !one.named; });
        Heard& heard = known == heard_.end() ? begin(*voice, sound) : *known;
        heard.named = true;
        heard.wanted = gainsOf(*voice, sound);
        heard.speed = voice->speed(sound.strength);
    }
}

void SoundMixer::render(Heard& heard, Chunk& chunk) const {
    const Samples& samples = heard.voice->samples;
    const double count = static_cast<double>(samples.size()), step = heard.speed * pace_;
    const double seconds = kChunk * pace_ / kSoundRate;
    std::array<float, 2> slope{};
    for (std::size_t side = 0; side < 2; ++side) {
        const double fade = heard.wanted[side] > heard.gain[side] ? kFadeIn : kFadeOut;
        const float end = moved(heard.gain[side], heard.wanted[side], static_cast<float>(seconds / fade));
        slope[side] = (end - heard.gain[side]) / static_cast<float>(kChunk);
    }
    for (std::size_t k = 0; k < kChunk; ++k) {
        if (heard.at >= count) {
            if (!heard.voice->continuous) break;
            heard.at -= count;
        }
        const auto before = static_cast<std::size_t>(heard.at);
        const std::size_t after = before + 1 < samples.size() ? before + 1 : heard.voice->continuous ? 0 : before;
        const auto share = static_cast<float>(heard.at - static_cast<double>(before));
        const float sample = samples[before] + share * (samples[after] - samples[before]);
        for (std::size_t side = 0; side < 2; ++side) {
            heard.gain[side] += slope[side];
            chunk[2 * k + side] += heard.gain[side] * sample;
        }
        heard.at += step;
    }
}

/// The gain at the end of a chunk that began with `begin`, so that neither it nor the next one passes the ceiling: down
/// within one chunk, up slowly.
float SoundMixer::limited(float begin, const Chunk& now, const Chunk& next) const {
    const float most = std::max(loudest(now), loudest(next));
    const float allowed = most > static_cast<float>(kCeiling) ? static_cast<float>(kCeiling) / most : 1.0F;
    const auto opens = static_cast<float>(kChunk * pace_ / kSoundRate / kRelease);
    return std::min(allowed, begin + opens);
}

void SoundMixer::nextChunk() {
    Chunk next{};
    if (sinceFrame_ > kPatience) goOn({});
    for (Heard& heard : heard_) render(heard, next);
    sinceFrame_ += kChunk * pace_ / kSoundRate;
    std::erase_if(heard_, [](const Heard& heard) {
        if (!heard.voice->continuous) return heard.at >= static_cast<double>(heard.voice->samples.size());
        return !heard.named && heard.gain[0] <= 1e-5F && heard.gain[1] <= 1e-5F;
    });
    const float master = moved(master_, masterWanted_, static_cast<float>(kChunk * pace_ / kSoundRate / kMasterFade));
    for (std::size_t k = 0; k < next.size(); ++k)
        next[k] *= master_ + (master - master_) * static_cast<float>(k / 2) / static_cast<float>(kChunk);
    master_ = master;
    // What was rendered before goes out now, by a gain that knows what comes.
    const float limit = limited(limit_, ahead_, next);
    for (std::size_t k = 0; k < ready_.size(); ++k) {
        const float gain = limit_ + (limit - limit_) * static_cast<float>(k / 2) / static_cast<float>(kChunk);
        ready_[k] = gain * ahead_[k];
    }
    limit_ = limit;
    ahead_ = next;
    used_ = 0;
    if (master_ == 0.0F && masterWanted_ == 0.0F) heard_.clear();
}

} // namespace lumorph
