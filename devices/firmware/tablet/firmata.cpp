#include "firmata.h"

#include <stdint.h>
#include <string.h>

#include "battery.h"
#include "channels.h"
#include "guards.h"
#include "pulses.h"
#include "sequence.h"
#include "uart.h"

namespace {

enum : uint8_t {
    kMillivolts = 0x02, // our own
    kStep = 0x03,       // our own
    kExtendedWrite = 0x6F,
    kAnalogMappingQuery = 0x69,
    kAnalogMapping = 0x6A,
    kCapabilityQuery = 0x6B,
    kCapability = 0x6C,
    kPinStateQuery = 0x6D,
    kPinState = 0x6E,
    kServoConfig = 0x70,
    kString = 0x71,
    kFirmware = 0x79,
    kSampling = 0x7A,
    kWrite = 0xE0,
    kSysexBegin = 0xF0,
    kPinMode = 0xF4,
    kSysexEnd = 0xF7,
    kVersion = 0xF9,
    kReset = 0xFF
};
enum : uint8_t { kModeInput = 0, kModeOutput = 1, kModeServo = 4, kModeNone = 0x7F };

constexpr uint8_t kPins = 20;
constexpr uint8_t kServoBits = 14;
constexpr uint16_t kGreatestDegrees = 180;
constexpr uint8_t kSilence = 500 / kFrameMilliseconds + 1; // frames: more than 500 ms, at most 520
constexpr int8_t kNoChannel = -1;

Limits limits[kChannelCount]; // as the studio set them, within those of channels.h
uint8_t silentFrames;

// The message that is coming in.
uint8_t command; // its first byte; 0: none
uint8_t data[16];
uint8_t length;
bool tooLong;

// ---- what we say

/// A message goes out as a whole or not at all: who asks faster than the line can answer must ask again.
bool beginMessage(uint8_t kind, uint8_t size) {
    if (uartRoom() < size + 3) return false;
    uartWrite(kSysexBegin);
    uartWrite(kind);
    return true;
}
void endMessage() { uartWrite(kSysexEnd); }

void writePair(uint16_t value) {
    uartWrite(value & 0x7F);
    uartWrite((value >> 7) & 0x7F);
}

void writeText(const char* text) {
    while (*text != 0) writePair(uint8_t(*text++));
}

/// Only when nothing else waits, so that a stream of mistakes does not drown the answers.
void sayError(const char* text) {
    if (uartHasUnsent() || !beginMessage(kString, 2 * strlen(text))) return;
    writeText(text);
    endMessage();
}

void sayVersion() {
    if (uartRoom() < 3) return;
    uartWrite(kVersion);
    uartWrite(2);
    uartWrite(5);
}

void sayFirmware() {
    const char name[] = "LumorphTablet";
    if (!beginMessage(kFirmware, 2 * sizeof(name))) return;
    uartWrite(1);
    uartWrite(2); // since 1.1 pulses begin at 500 us, since 1.2 it knows steps
    writeText(name);
    endMessage();
}

int8_t channelOf(uint8_t pin) {
    for (uint8_t i = 0; i < kChannelCount; ++i)
        if (kChannels[i].pin == pin) return i;
    return kNoChannel;
}

void sayCapabilities() {
    if (!beginMessage(kCapability, kPins + 2 * kChannelCount)) return;
    for (uint8_t pin = 0; pin < kPins; ++pin) {
        if (channelOf(pin) != kNoChannel) {
            uartWrite(kModeServo);
            uartWrite(kServoBits);
        }
        uartWrite(0x7F);
    }
    endMessage();
}

void sayAnalogMapping() {
    if (!beginMessage(kAnalogMapping, kPins)) return;
    for (uint8_t pin = 0; pin < kPins; ++pin) uartWrite(0x7F); // none can be asked for
    endMessage();
}

void sayPinState(uint8_t pin) {
    if (!beginMessage(kPinState, 4)) return;
    const int8_t channel = channelOf(pin);
    uartWrite(pin);
    if (channel != kNoChannel) {
        uartWrite(isOn(channel) ? kModeServo : kModeOutput);
        writePair(pulseOf(channel));
    } else if (pin < kPins) {
        uartWrite(kModeNone);
        uartWrite(0);
    }
    endMessage();
}

void sayMillivolts() {
    if (!beginMessage(kMillivolts, 3)) return;
    const uint32_t millivolts = batteryMillivolts();
    writePair(uint16_t(millivolts & 0x3FFF));
    uartWrite((millivolts >> 14) & 0x7F);
    endMessage();
}

// ---- what we are told

uint16_t within(uint16_t value, uint16_t least, uint16_t greatest) {
    return value < least ? least : value > greatest ? greatest : value;
}

void write(uint8_t pin, uint16_t value) {
    const int8_t channel = channelOf(pin);
    if (channel == kNoChannel) return sayError("No servo on this pin");
    const Limits& limit = limits[channel];
    if (value <= kGreatestDegrees)
        value = limit.least + uint32_t(limit.greatest - limit.least) * value / kGreatestDegrees;
    else if (value < kLeastPulse)
        return sayError("Neither degrees nor microseconds");
    setPulse(channel, within(value, limit.least, limit.greatest));
}

void extendedWrite() {
    if (length < 3) return sayError("Message too short");
    uint16_t value = 0;
    for (uint8_t i = length; i-- > 1;) value = value > 0x1FF ? 0xFFFF : (value << 7) | data[i];
    write(data[0], value);
}

void configure() {
    if (length != 5) return sayError("Message too short");
    const int8_t channel = channelOf(data[0]);
    if (channel == kNoChannel) return sayError("No servo on this pin");
    const ChannelSetup& setup = kChannels[channel];
    const uint16_t least = data[1] | uint16_t(data[2]) << 7;
    const uint16_t greatest = data[3] | uint16_t(data[4]) << 7;
    if (least > greatest) return sayError("Limits the wrong way round");
    limits[channel] =
        safeLimits(within(least, setup.least, setup.greatest), within(greatest, setup.least, setup.greatest));
}

void configureStep() {
    if (length != 3) return sayError("Message too short");
    const int8_t channel = channelOf(data[0]);
    if (channel == kNoChannel) return sayError("No servo on this pin");
    setStep(channel, data[1] | uint16_t(data[2]) << 7);
}

void setMode(uint8_t pin, uint8_t mode) {
    const int8_t channel = channelOf(pin);
    if (channel == kNoChannel) return sayError("No servo on this pin");
    if (mode == kModeServo) {
        // A width from before limits were narrowed would begin beyond them.
        if (!isOn(channel) && pulseOf(channel) != 0)
            setPulse(channel, within(pulseOf(channel), limits[channel].least, limits[channel].greatest));
        setOn(channel, true);
    } else if (mode == kModeOutput || mode == kModeInput) {
        setOn(channel, false);
    } else {
        sayError("Unknown pin mode");
    }
}

void reset() {
    forgetPulses();
    for (uint8_t i = 0; i < kChannelCount; ++i) limits[i] = safeLimits(kChannels[i].least, kChannels[i].greatest);
}

void takeSysex(uint8_t kind) {
    switch (kind) {
    case kMillivolts:
        return sayMillivolts();
    case kFirmware:
        return sayFirmware();
    case kCapabilityQuery:
        return sayCapabilities();
    case kAnalogMappingQuery:
        return sayAnalogMapping();
    case kPinStateQuery:
        return length == 1 ? sayPinState(data[0]) : sayError("Message too short");
    case kExtendedWrite:
        return extendedWrite();
    case kServoConfig:
        return configure();
    case kStep:
        return configureStep();
    case kSampling:
    case kString:
        return;
    default:
        return sayError("Unknown message");
    }
}

void endSysex() {
    if (tooLong) return sayError("Message too long");
    if (length == 0) return;
    const uint8_t kind = data[0];
    --length;
    memmove(data, data + 1, length);
    takeSysex(kind);
}

void takeCommand(uint8_t byte) {
    const bool endsSysex = byte == kSysexEnd && command == kSysexBegin;
    command = 0;
    if (endsSysex) return endSysex();
    length = 0;
    tooLong = false;
    if (byte == kReset) return reset();
    if (byte == kVersion) return sayVersion();
    if (byte == kSysexBegin || byte == kPinMode || (byte & 0xF0) == kWrite) command = byte;
}

void takeData(uint8_t byte) {
    if (command == 0) return; // of a message that we do not know
    if (length == sizeof(data)) {
        tooLong = true;
        return;
    }
    data[length++] = byte;
    if (command == kSysexBegin || length < 2) return;
    const uint8_t whole = command;
    command = 0;
    if (whole == kPinMode) return setMode(data[0], data[1]);
    write(whole & 0x0F, data[0] | uint16_t(data[1]) << 7);
}

} // namespace

void firmataBegin() {
    reset();
    sayVersion();
    sayFirmware();
    if (!restartedAfterHang()) return;
    uartSend();
    if (beginMessage(kString, 42)) {
        writeText("Started anew: it hung");
        endMessage();
    }
}

void firmataRead() {
    for (uint8_t i = 0; i < 16; ++i) {
        const int16_t byte = uartRead();
        if (byte < 0) return;
        silentFrames = 0;
        sequenceTakenOver();
        if (byte & 0x80)
            takeCommand(uint8_t(byte));
        else
            takeData(uint8_t(byte));
    }
}

bool firmataIsSilent() { return silentFrames >= kSilence; }

void firmataFrame() {
    if (uartLostBytes()) {
        command = 0; // something is missing in its midst
        sayError("Bytes were lost");
    }
    if (silentFrames < kSilence) {
        ++silentFrames;
        return;
    }
    if (!anyOn() || sequencePlays()) return;
    allOff();
    sayError("Silence: servos let go");
}
