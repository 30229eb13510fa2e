#include "sequence.h"

#include <avr/io.h>

#include "firmata.h"
#include "guards.h"
#include "poses.h"
#include "pulses.h"

static_assert(sizeof(PoseStep) == 10, "as much as Lumorph reckons");

namespace {

constexpr uint8_t kQuietFrames = 3000 / kFrameMilliseconds;
constexpr uint8_t kSteadyFrames = 2; // a button's contacts bounce for less than this

enum State : uint8_t { kIdle, kStarting, kPlaying, kEnded };
State state;
uint16_t step;                // that plays
uint32_t frame;               // of that step
uint16_t from[kChannelCount]; // where its way begins
uint8_t next;                 // channel that is started next
uint8_t wait;                 // frames until then
bool waitsForPower;           // it will begin by itself
uint8_t quiet;                // frames since power on
uint8_t low;                  // frames for which the button has been down
bool wasLow = true;           // one that is down at power on does not count

uint16_t pulseAt(uint8_t row, uint8_t channel) { return pgm_read_word(&kPosePulses[row][channel]); }

PoseStep stepAt(uint16_t index) {
    PoseStep read;
    memcpy_P(&read, &kPoseTable[index], sizeof(read));
    return read;
}

/// The share of the way after `done` of `all` frames, in 1 / 32768.
uint16_t shareOf(PoseEasing easing, uint32_t done, uint32_t all) {
    const uint32_t u = (done << 14) / all;           // of 2^14; an hour has 180,000 frames
    const uint32_t u2 = (u * u + (1UL << 11)) >> 12; // of 2^16
    if (easing == kSmoothly) return (u2 * ((3UL << 14) - 2 * u) + (1UL << 14)) >> 15; // u^2 (3 - 2 u)
    const uint32_t u3 = (u2 * u + (1UL << 13)) >> 14;                                 // of 2^16
    const uint32_t rest = (10UL << 14) + ((6 * u2) >> 2) - 15 * u;                    // 10 - 15 u + 6 u^2, of 2^14
    return (u3 * rest + (1UL << 14)) >> 15;
}

bool pressed() {
    if (kPoseButton == 0) return false;
    const bool isLow = !(kPoseButton < 8    ? PIND & _BV(kPoseButton & 7)
                         : kPoseButton < 14 ? PINB & _BV((kPoseButton - 8) & 7)
                                            : PINC & _BV((kPoseButton - 14) & 7));
    low = !isLow ? 0 : low < kSteadyFrames ? low + 1 : low;
    const bool isDown = low == kSteadyFrames;
    if (!isLow) wasLow = false;
    if (!isDown || wasLow) return false;
    wasLow = true;
    return true;
}

void start() {
    for (uint8_t i = 0; i < kChannelCount; ++i) {
        if (pulseOf(i) == 0) setPulse(i, pulseAt(0, i));
        setStep(i, pgm_read_word(&kPoseFastest[i]));
        from[i] = pulseOf(i);
    }
    state = kStarting;
    next = 0;
    wait = 0;
    step = 0;
    frame = 0;
}

void startServos() {
    while (next < kChannelCount && isOn(next)) ++next;
    if (next == kChannelCount) {
        if (wait > 0) --wait;
        if (wait == 0) state = kPlaying;
        return;
    }
    if (wait > 0) {
        --wait;
        return;
    }
    setOn(next++, true);
    wait = kPoseStagger;
}

/// The next step begins where this one ends.
void nextStep(const PoseStep& done) {
    for (uint8_t i = 0; i < kChannelCount; ++i) from[i] = pulseAt(done.pose, i);
    frame = 0;
    if (++step != kPoseSteps) return;
    step = 0;
    if (!kPoseLoop) state = kEnded;
}

/// Where the way of the step ahead begins, or the last one has ended.
void stay() {
    for (uint8_t i = 0; i < kChannelCount; ++i) setPulse(i, from[i]);
}

void playFrame() {
    PoseStep now = stepAt(step);
    for (uint16_t skipped = 0; now.travel + now.hold == 0 && skipped != kPoseSteps; ++skipped) { // takes no time at all
        nextStep(now);
        if (state == kEnded) return stay();
        now = stepAt(step);
    }
    const bool onTheWay = frame < now.travel;
    const uint16_t share = onTheWay ? shareOf(now.easing, frame, now.travel) : 1U << 15;
    for (uint8_t i = 0; i < kChannelCount; ++i) {
        const int32_t way = int32_t(pulseAt(now.pose, i)) - from[i];
        setPulse(i, uint16_t(from[i] + ((way * share + (1L << 14)) >> 15)));
    }
    ++frame;
    if (frame >= now.travel + now.hold) nextStep(now);
}

} // namespace

void sequenceBegin() {
    if (kPoseSteps == 0) return;
    waitsForPower = kPoseButton == 0 && !restartedAfterHang();
    if (kPoseButton == 0) return;
    if (kPoseButton < 8)
        PORTD |= _BV(kPoseButton & 7);
    else if (kPoseButton < 14)
        PORTB |= _BV((kPoseButton - 8) & 7);
    else
        PORTC |= _BV((kPoseButton - 14) & 7);
}

void sequenceFrame() {
    if (kPoseSteps == 0) return;
    if (waitsForPower && ++quiet == kQuietFrames) {
        waitsForPower = false;
        start();
    }
    if (pressed() && firmataIsSilent()) {
        if (state == kIdle || state == kEnded) {
            start();
        } else {
            allOff();
            state = kIdle;
        }
    }
    if (state == kStarting) startServos();
    if (state == kPlaying)
        playFrame();
    else if (state == kEnded)
        stay();
}

bool sequencePlays() { return kPoseSteps != 0 && state != kIdle; }

void sequenceTakenOver() {
    waitsForPower = false;
    if (!sequencePlays()) return;
    forgetPulses();
    state = kIdle;
}
