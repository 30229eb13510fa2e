#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "devices/controllers/device_profile.h"

namespace lumorph {

/// What a board is told of one servo.
struct WireOrder {
    int channel = 0;
    std::optional<double> pulse; ///< microseconds; nothing: let go
    double seconds = 0.0;        ///< that the servo takes its time, where the board is told so
};

/// Reads messages to the three kinds of boards, by hand from their documents; shares no code with the encoders.
class WireReader {
public:
    explicit WireReader(ControllerKind kind) : kind_(kind) {}

    std::vector<WireOrder> receive(std::vector<std::uint8_t> message) {
        orders_.clear();
        switch (kind_) {
        case ControllerKind::firmata:
            readFirmata(message);
            break;
        case ControllerKind::lewansoul:
            readLewansoul(message);
            break;
        case ControllerKind::maestro:
            readMaestro(message);
            break;
        }
        return orders_;
    }

private:
    using Bytes = std::vector<std::uint8_t>;

    void readFirmata(Bytes m) {
        if (!m.empty() && m[0] == 0xF7) m.erase(m.begin()); // the end of whatever was before
        if (m.size() == 1 && m[0] == 0xFF) {                // reset
            for (const int pin : driven_) orders_.push_back({pin, std::nullopt});
            driven_.clear();
            written_.clear();
        }
        if (m.size() == 3 && m[0] >= 0xE0 && m[0] <= 0xEF) write(m[0] & 0x0F, m[1] | m[2] << 7);
        if (m.size() >= 6 && m[0] == 0xF0 && m[1] == 0x6F) {
            int value = 0;
            for (std::size_t i = 3; i + 1 < m.size(); ++i) value |= m[i] << (7 * (i - 3));
            write(m[2], value);
        }
        // Ours attaches by F4 alone.
        if (m.size() == 3 && m[0] == 0xF4) {
            const int pin = m[1];
            if (m[2] == 4) {
                if (driven_.insert(pin).second && written_.contains(pin)) orders_.push_back({pin, written_[pin]});
            } else {
                driven_.erase(pin);
                orders_.push_back({pin, std::nullopt});
            }
        }
    }
    void write(int pin, int microseconds) {
        written_[pin] = microseconds;
        if (driven_.contains(pin)) orders_.push_back({pin, microseconds});
    }
    void readLewansoul(const Bytes& m) {
        if (m.size() < 5 || m[0] != 0x55 || m[1] != 0x55) return;
        if (m[3] == 0x03)
            for (std::size_t i = 7; i < 7 + 3U * m[4]; i += 3)
                orders_.push_back({m.at(i), 500.0 + 2.0 * (m.at(i + 1) | m.at(i + 2) << 8), 1e-3 * (m[5] | m[6] << 8)});
        if (m[3] == 0x14)
            for (std::size_t i = 5; i < 5U + m[4]; ++i) orders_.push_back({m.at(i), std::nullopt});
    }
    void readMaestro(const Bytes& m) {
        if (m.size() != 6 || m[0] != 0xAA || m[1] != 12 || m[2] != 0x04) return;
        const int quarters = m[4] | m[5] << 7;
        if (quarters == 0)
            orders_.push_back({m[3], std::nullopt});
        else
            orders_.push_back({m[3], 0.25 * quarters});
    }

    ControllerKind kind_;
    std::vector<WireOrder> orders_;
    std::map<int, int> written_; ///< by pin
    std::set<int> driven_;
};

} // namespace lumorph
