#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace lumorph {

/// Random moves to show a device off: every 0.6 to 1.4 seconds some actuators get a new wish. The same seed and times
/// give the same dance. It asks for jumps; the motion limits make them smooth.
class Dance {
public:
    explicit Dance(std::uint64_t seed = 1) : random_(seed) {}

    /// What is wished for `seconds` after the last call, strokes. The first call after `end` (or with another number of
    /// strokes) starts at `from`.
    [[nodiscard]] const std::vector<double>& step(std::span<const double> from, double seconds);
    void end() noexcept { wish_.clear(); }

private:
    double between(double low, double high);
    void change();

    std::mt19937_64 random_;
    std::vector<double> wish_;
    double untilNext_ = 0.0;
};

} // namespace lumorph
