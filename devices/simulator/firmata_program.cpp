#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "devices/simulator/board_program.h"

namespace lumorph {

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kPins = 20;
constexpr int kFirstServo = 2;
constexpr int kLastServo = 13;
constexpr int kFirstAnalog = 14;
constexpr std::uint8_t kOutput = 0x01;
constexpr std::uint8_t kServo = 0x04;
constexpr int kLeastMicroseconds = 544; // a value below is an angle
constexpr int kOurLeastMicroseconds = 500;
constexpr double kMiddle = 1502.0; // microseconds, measured on the real firmware
constexpr std::size_t kSysexBuffer = 64;
constexpr Microseconds kSilence{500'000};

bool isServo(int pin) { return pin >= kFirstServo && pin <= kLastServo; }

struct Pin {
    std::uint8_t mode = kOutput;
    int value = 0; ///< last written, as it was written
    int anglesBelow = kLeastMicroseconds;
    int least = kLeastMicroseconds;
    int greatest = 2400;

    [[nodiscard]] double pulse() const {
        const double microseconds =
            value >= anglesBelow ? value : least + (greatest - least) * std::min(value, 180) / 180.0;
        return std::clamp(microseconds, static_cast<double>(least), static_cast<double>(greatest));
    }
};

class Firmata final : public BoardProgram {
public:
    Firmata(BoardHardware& hardware, bool ours) : hardware_(hardware), ours_(ours) { pins_.fill(freshPin()); }

    void greet() override {
        sayVersion();
        sayFirmware();
    }

    void receive(std::span<const std::uint8_t> bytes, Microseconds now) override {
        lastHeard_ = now;
        for (const std::uint8_t byte : bytes) receiveByte(byte);
    }

    [[nodiscard]] std::optional<Microseconds> alarm() const override {
        if (!ours_ || std::ranges::none_of(pins_, [](const Pin& pin) { return pin.mode == kServo; }))
            return std::nullopt;
        return lastHeard_ + kSilence;
    }

    void wake(Microseconds) override {
        for (Pin& pin : pins_)
            if (pin.mode == kServo) pin.mode = kOutput;
        hardware_.servos.allLimp();
    }

private:
    void receiveByte(std::uint8_t byte) {
        if (inSysex_ && byte == 0xF7) {
            inSysex_ = false;
            if (!data_.empty()) sysex(data_.front(), std::span(data_).subspan(1));
        } else if (inSysex_ && (byte < 0x80 || !ours_)) { // the stock parser takes all for data until F7
            if (data_.size() < kSysexBuffer) data_.push_back(byte);
        } else if (byte >= 0x80) {
            begin(byte);
        } else if (data_.size() < awaited_) {
            data_.push_back(byte);
            if (data_.size() == awaited_) shortMessage();
        }
    }

    void begin(std::uint8_t status) {
        if (!ours_ && status == 0xF7) return; // the end of nothing: data of what was begun before may still come
        status_ = status;
        data_.clear();
        inSysex_ = status == 0xF0;
        const int kind = status < 0xF0 ? status & 0xF0 : status;
        awaited_ = kind == 0xE0 || kind == 0x90 || kind == 0xF4 || kind == 0xF5 ? 2 : 0;
        if (status == 0xF9) sayVersion();
        if (status == 0xFF) reset();
    }

    void shortMessage() {
        if ((status_ & 0xF0) == 0xE0) write(status_ & 0x0F, data_[0] | data_[1] << 7);
        if (status_ == 0xF4) setMode(data_[0], data_[1]);
        awaited_ = 0;
    }

    void sysex(std::uint8_t command, std::span<const std::uint8_t> data) {
        if (command == 0x79 && data.empty()) sayFirmware();
        if (command == 0x6B) sayCapabilities();
        if (command == 0x69) sayAnalogMapping();
        if (command == 0x6D && !data.empty()) sayPinState(data[0]);
        if (command == 0x6F && data.size() >= 2) writeExtended(data[0], data.subspan(1));
        if (command == 0x70 && data.size() >= 5) configure(data[0], data[1] | data[2] << 7, data[3] | data[4] << 7);
        if (command == 0x02 && data.empty() && ours_) sayVoltage();
    }

    void writeExtended(int pin, std::span<const std::uint8_t> groups) {
        int value = 0;
        for (std::size_t i = 0; i < std::min<std::size_t>(groups.size(), 3); ++i)
            value |= (groups[i] & 0x7F) << (7 * i);
        write(pin, value);
    }

    void write(int pin, int value) {
        if (!isServo(pin) || (!ours_ && pins_[pin].mode != kServo)) return;
        pins_[pin].value = value;
        written_[pin] = true;
        if (pins_[pin].mode == kServo) drive(pin, pins_[pin].pulse());
    }

    void setMode(int pin, std::uint8_t mode) {
        constexpr std::array<std::uint8_t, 7> kKnown{0x00, 0x01, 0x02, 0x03, 0x04, 0x06, 0x0B};
        if (pin >= kPins) return;
        if (std::ranges::find(kKnown, mode) == kKnown.end()) return sayString("Unknown pin mode");
        if (mode == kServo) return attach(pin);
        pins_[pin].mode = mode;
        if (!ours_) pins_[pin].value = 0;
        drive(pin, 0.0);
    }

    void configure(int pin, int least, int greatest) {
        if (!isServo(pin) || least <= 0 || least >= greatest) return;
        pins_[pin].least = least;
        pins_[pin].greatest = greatest;
        attach(pin);
    }

    void attach(int pin) {
        if (!isServo(pin) || pins_[pin].mode == kServo) return;
        pins_[pin].mode = kServo;
        if (!ours_) {
            pins_[pin].value = 0;
            drive(pin, kMiddle);
        } else if (written_[pin]) {
            drive(pin, pins_[pin].pulse());
        }
    }

    void drive(int pin, double microseconds) {
        if (isServo(pin)) hardware_.servos.setPulse(static_cast<std::size_t>(pin - kFirstServo), microseconds);
    }

    void reset() {
        pins_.fill(freshPin());
        written_.fill(false);
        hardware_.servos.allLimp();
    }

    [[nodiscard]] Pin freshPin() const {
        Pin pin;
        if (ours_) {
            pin.anglesBelow = pin.least = kOurLeastMicroseconds;
            pin.greatest = 2500;
        }
        return pin;
    }

    void say(Bytes message) { hardware_.said.push_back(std::move(message)); }
    void sayVersion() { say({0xF9, 0x02, 0x05}); }

    void sayText(Bytes message, std::string_view text) {
        for (const char letter : text)
            message.insert(message.end(), {static_cast<std::uint8_t>(letter), 0x00}); // ASCII: nothing in the high half
        message.push_back(0xF7);
        say(std::move(message));
    }
    void sayString(std::string_view text) { sayText({0xF0, 0x71}, text); }
    void sayFirmware() {
        if (ours_)
            sayText({0xF0, 0x79, 0x01, 0x02}, "LumorphTablet");
        else
            sayText({0xF0, 0x79, 0x02, 0x05}, "StandardFirmata");
    }

    void sayCapabilities() {
        Bytes message{0xF0, 0x6C};
        for (int pin = 0; pin < kPins; ++pin) {
            if (!ours_ && pin >= kFirstServo) message.insert(message.end(), {0x00, 1, 0x01, 1}); // digital
            if (!ours_ && pin >= kFirstAnalog) message.insert(message.end(), {0x02, 10});
            if (isServo(pin)) message.insert(message.end(), {kServo, 14});
            message.push_back(0x7F);
        }
        message.push_back(0xF7);
        say(std::move(message));
    }

    void sayAnalogMapping() {
        Bytes message{0xF0, 0x6A};
        for (int pin = 0; pin < kPins; ++pin)
            message.push_back(!ours_ && pin >= kFirstAnalog ? static_cast<std::uint8_t>(pin - kFirstAnalog) : 0x7F);
        message.push_back(0xF7);
        say(std::move(message));
    }

    void sayPinState(std::uint8_t pin) {
        Bytes message{0xF0, 0x6E, pin};
        if (pin < kPins) {
            message.push_back(pins_[pin].mode);
            int rest = pins_[pin].value;
            do {
                message.push_back(static_cast<std::uint8_t>(rest & 0x7F));
                rest >>= 7;
            } while (rest > 0);
        }
        message.push_back(0xF7);
        say(std::move(message));
    }

    void sayVoltage() {
        const auto millivolts = static_cast<unsigned>(std::lround(1000.0 * hardware_.volts));
        say({0xF0, 0x02, static_cast<std::uint8_t>(millivolts & 0x7F),
             static_cast<std::uint8_t>(millivolts >> 7 & 0x7F), static_cast<std::uint8_t>(millivolts >> 14 & 0x7F),
             0xF7});
    }

    BoardHardware& hardware_;
    const bool ours_;
    std::array<Pin, kPins> pins_;
    std::array<bool, kPins> written_{}; ///< a pulse is known for the attach
    Microseconds lastHeard_{0};
    std::uint8_t status_ = 0; ///< of the message that is under way
    std::size_t awaited_ = 0; ///< bytes of its data
    bool inSysex_ = false;
    Bytes data_;
};

} // namespace

std::unique_ptr<BoardProgram> makeTabletProgram(BoardHardware& hardware) {
    return std::make_unique<Firmata>(hardware, true);
}

std::unique_ptr<BoardProgram> makeStandardFirmataProgram(BoardHardware& hardware) {
    return std::make_unique<Firmata>(hardware, false);
}

} // namespace lumorph
