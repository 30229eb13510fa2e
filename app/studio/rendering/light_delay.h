#pragma once

namespace lumorph::studio {

/// The usual delay from a frame of the loop to its light, by which poses and servos are predicted: an average over the
/// frames that were drawn of late.
class LightDelay {
public:
    /// Longer delays count as this, milliseconds.
    static constexpr double kLongest = 300.0;

    /// A frame was drawn for the first time, this long after it was made. A single delay above `kLongest` is a stop of
    /// loop, window or renderer, and says nothing about the frames after it; it counts where the next is as long.
    void add(double milliseconds) noexcept;
    [[nodiscard]] double usual() const noexcept { return usual_; } ///< milliseconds; 0 before the first

private:
    double usual_ = 0.0;
    bool isLong_ = false; ///< the last one was
};

} // namespace lumorph::studio
