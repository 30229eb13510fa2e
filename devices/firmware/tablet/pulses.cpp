#include "pulses.h"

#include <avr/interrupt.h>
#include <avr/io.h>

#include "channels.h"

static_assert(kChannelCount >= 1 && kChannelCount <= 12, "1 to 12 channels");
static_assert(F_CPU == 8000000UL || F_CPU == 16000000UL, "a Pro Mini of 8 or 16 MHz");

namespace {

// Timer1 counts an eighth of the clock: 1 us at 8 MHz, 0.5 us at 16 MHz. One round is one frame: first a time in which
// the next frame is laid out and taken over, then the pulses.
constexpr uint16_t kTick = F_CPU / 8000000UL; // ticks a microsecond
constexpr uint16_t kTop = kFrameMilliseconds * 1000U * kTick - 1;
constexpr uint16_t kFrameStart = 3000 * kTick;
constexpr uint16_t kFirstEdge = 3200 * kTick;
constexpr uint16_t kSecondGroup = 250 * kTick; // later than the first, so that fewer edges meet
constexpr uint16_t kAhead = 20 * kTick;        // longer than another interrupt and our own entry take together
constexpr uint16_t kNear = 30 * kTick;         // too near to leave the interrupt and come back in time
constexpr uint16_t kLeaving = 4 * kTick;       // what leaving takes
constexpr uint16_t kNever = 0xFFFF;
constexpr uint8_t kGroup = 6; // channels whose pulses fit into a frame one after the other
static_assert(kFirstEdge + kSecondGroup + kGroup * (kGreatestPulse * kTick) + 500 < kTop, "a frame holds all pulses");
constexpr uint8_t kMostEdges = 2 * (kGroup + 1);

struct Ports {
    uint8_t b, c, d;
};

/// What the ports' registers shall be from a time on. Times of the interrupt are laid out beforehand: where two edges
/// are near each other, there is no time left to reckon.
struct Edge {
    Ports ports;
    uint8_t low;   // of the time's two bytes
    bool nextNear; // the next edge is waited for at once
    uint16_t time;
    uint16_t wake; // when the interrupt shall come for it
};

struct Channel {
    uint16_t width; // microseconds; 0: never given
    uint16_t step;  // most from one frame to the next; 0: any
    uint16_t now;   // of the frame that is laid out; 0: none yet since it is on
    bool on;
};

Channel channels[kChannelCount];
// The interrupt plays one frame while the next is laid out in the other.
Edge frames[2][kMostEdges + 1];
volatile uint8_t playing;
volatile bool isPlanned;
volatile bool planIsDue;
volatile bool restart;
const Edge* volatile nextEdge;

constexpr uint8_t bitOf(uint8_t pin) { return pin < 8 ? 1U << pin : pin < 14 ? 1U << (pin - 8) : 1U << (pin - 14); }

Ports bitsOf(uint8_t channel) {
    const uint8_t pin = kChannels[channel].pin;
    const uint8_t bit = bitOf(pin);
    return {uint8_t(pin >= 8 && pin < 14 ? bit : 0), uint8_t(pin >= 14 ? bit : 0), uint8_t(pin < 8 ? bit : 0)};
}

void toggle(Ports& ports, const Ports& bits) {
    ports.b ^= bits.b;
    ports.c ^= bits.c;
    ports.d ^= bits.d;
}

/// Adds an edge that toggles bits to a list that is ordered by time.
uint8_t addEdge(Edge* edges, uint8_t count, uint16_t time, const Ports& bits) {
    uint8_t at = count;
    while (at > 0 && edges[at - 1].time >= time) --at;
    if (at < count && edges[at].time == time) {
        toggle(edges[at].ports, bits);
        return count;
    }
    for (uint8_t i = count; i > at; --i) edges[i] = edges[i - 1];
    edges[at] = {bits, uint8_t(time), false, time, uint16_t(time - kAhead)};
    return count + 1;
}

/// Pulses of one group, each beginning where the one before ends.
uint8_t addGroup(Edge* edges, uint8_t count, uint8_t first, uint8_t end, uint16_t time) {
    for (uint8_t i = first; i < end; ++i) {
        const Channel& channel = channels[i];
        if (!channel.on || channel.now < kLeastPulse || channel.now > kGreatestPulse) continue;
        count = addEdge(edges, count, time, bitsOf(i));
        time += channel.now * kTick;
        count = addEdge(edges, count, time, bitsOf(i));
    }
    return count;
}

/// One frame nearer to what each channel was given.
void advance(Channel& channel) {
    if (!channel.on)
        channel.now = 0;
    else if (channel.now == 0 || channel.step == 0)
        channel.now = channel.width;
    else if (channel.width > channel.now)
        channel.now += channel.width - channel.now < channel.step ? channel.width - channel.now : channel.step;
    else
        channel.now -= channel.now - channel.width < channel.step ? channel.now - channel.width : channel.step;
}

uint8_t clampedEnd(uint8_t end) { return end < kChannelCount ? end : kChannelCount; }

[[noreturn]] void startAnew() {
    TIMSK1 = 0;
    UCSR0B = 0;
    asm volatile("jmp 0");
    __builtin_unreachable();
}

/// Between two frames, all pins low.
const Edge* beginFrame() {
    if (restart) startAnew();
    if (isPlanned) {
        playing ^= 1;
        isPlanned = false;
    }
    return frames[playing];
}

} // namespace

// An edge must not wait for another interrupt to end: this one comes early enough to outlast any of them, and then
// waits for the very tick. Where edges of the two groups lie near each other, both are served in one go.
ISR(TIMER1_COMPB_vect) {
    const Edge* edge = nextEdge;
    if (edge == nullptr) edge = beginFrame();
    while (edge->time != kNever) {
        if (int16_t(edge->wake - TCNT1) > int16_t(kLeaving)) {
            OCR1B = edge->wake;
            nextEdge = edge;
            return;
        }
        bool more;
        do {
            const Ports ports = edge->ports;
            const uint8_t low = edge->low;
            while (int8_t(TCNT1L - low) < 0) {
            }
            PORTB = ports.b;
            PORTC = ports.c;
            PORTD = ports.d;
            more = edge->nextNear;
            ++edge;
        } while (more);
    }
    nextEdge = nullptr;
    OCR1B = kFrameStart;
}

// The round's end.
ISR(TIMER1_COMPA_vect) { planIsDue = true; }

void pulsesBegin() {
    for (uint8_t i = 0; i < kChannelCount; ++i) {
        const Ports bits = bitsOf(i);
        PORTB &= ~bits.b;
        PORTC &= ~bits.c;
        PORTD &= ~bits.d;
        DDRB |= bits.b;
        DDRC |= bits.c;
        DDRD |= bits.d;
    }
    pulsesPlan();
    TCCR1A = 0;
    TCCR1B = 0;
    TCNT1 = 0;
    OCR1A = kTop;
    OCR1B = kFrameStart;
    TIFR1 = 0xFF;
    TIMSK1 = _BV(OCIE1A) | _BV(OCIE1B);
    TCCR1B = _BV(WGM12) | _BV(CS11);
}

Limits safeLimits(uint16_t least, uint16_t greatest) {
    if (least < kLeastPulse) least = kLeastPulse;
    if (greatest > kGreatestPulse) greatest = kGreatestPulse;
    if (greatest < least + 2 * kEdgeError) {
        const uint16_t middle = least + (greatest > least ? (greatest - least) / 2 : 0);
        return {middle, middle};
    }
    return {uint16_t(least + kEdgeError), uint16_t(greatest - kEdgeError)};
}

void setPulse(uint8_t channel, uint16_t microseconds) {
    const Limits hard = safeLimits(kChannels[channel].least, kChannels[channel].greatest);
    channels[channel].width = microseconds < hard.least      ? hard.least
                              : microseconds > hard.greatest ? hard.greatest
                                                             : microseconds;
}

void setStep(uint8_t channel, uint16_t microseconds) { channels[channel].step = microseconds; }
void setOn(uint8_t channel, bool on) { channels[channel].on = on; }
bool isOn(uint8_t channel) { return channels[channel].on; }
uint16_t pulseOf(uint8_t channel) { return channels[channel].width; }

void forgetPulses() {
    for (Channel& channel : channels) channel = {0, 0, 0, false};
}

void allOff() {
    for (Channel& channel : channels) channel.on = false;
}

bool anyOn() {
    for (const Channel& channel : channels)
        if (channel.on) return true;
    return false;
}

bool pulsesFrameWaits() { return planIsDue; }

bool pulsesFrameIsDue() {
    if (!planIsDue) return false;
    planIsDue = false;
    return true;
}

void pulsesPlan() {
    isPlanned = false; // from here on the interrupt does not change `playing`
    for (Channel& channel : channels) advance(channel);
    Edge* edges = frames[playing ^ 1];
    uint8_t count = addGroup(edges, 0, 0, clampedEnd(kGroup), kFirstEdge);
    count = addGroup(edges, count, clampedEnd(kGroup), kChannelCount, kFirstEdge + kSecondGroup);
    // Pins that are no servo's keep their bits, above all the pull-up of the receiving line.
    Ports ports = {PORTB, PORTC, PORTD};
    for (uint8_t i = 0; i < kChannelCount; ++i) {
        const Ports bits = bitsOf(i);
        ports = {uint8_t(ports.b & ~bits.b), uint8_t(ports.c & ~bits.c), uint8_t(ports.d & ~bits.d)};
    }
    for (uint8_t i = 0; i < count; ++i) {
        toggle(ports, edges[i].ports);
        edges[i].ports = ports;
        edges[i].nextNear = i + 1 < count && edges[i + 1].time - edges[i].time < kNear;
    }
    edges[count].time = kNever;
    isPlanned = true;
}

void restartAfterThisFrame() { restart = true; }
