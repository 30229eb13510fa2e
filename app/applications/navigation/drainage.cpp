#include "app/applications/navigation/drainage.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumorph::navigation {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr glm::ivec2 kNeighbours[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};

/// Samples that wait to be flooded, the lowest first to within a step.
class HeightQueue {
public:
    HeightQueue(float lowest, float highest, std::size_t samples)
        : lowest_(lowest), step_(std::max((highest - lowest) / kBuckets, 1e-6F)), first_(kBuckets + 2, kNone),
          next_(samples, kNone) {}

    void push(std::uint32_t sample, float height) {
        const auto bucket = std::min<std::size_t>(static_cast<std::size_t>(std::max(0.0F, (height - lowest_) / step_)),
                                                  first_.size() - 1);
        next_[sample] = first_[bucket];
        first_[bucket] = sample;
        current_ = std::min(current_, bucket);
    }
    /// kNone at the end.
    std::uint32_t pop() {
        while (current_ < first_.size() && first_[current_] == kNone) ++current_;
        if (current_ == first_.size()) return kNone;
        const std::uint32_t sample = first_[current_];
        first_[current_] = next_[sample];
        return sample;
    }

private:
    static constexpr int kBuckets = 1 << 15;
    float lowest_, step_;
    std::vector<std::uint32_t> first_, next_;
    std::size_t current_ = 0;
};

template <typename Each> void forNeighbours(glm::ivec2 samples, std::uint32_t sample, const Each& each) {
    const auto columns = static_cast<std::uint32_t>(samples.x);
    const glm::ivec2 at(static_cast<int>(sample % columns), static_cast<int>(sample / columns));
    for (const glm::ivec2& by : kNeighbours) {
        const glm::ivec2 n = at + by;
        if (n.x < 0 || n.y < 0 || n.x >= samples.x || n.y >= samples.y) continue;
        each(static_cast<std::uint32_t>(n.y) * columns + static_cast<std::uint32_t>(n.x));
    }
}

} // namespace

// Priority flood (Barnes, Lehman and Mulla) with a queue that is in order only to within a step: a sample is never
// lower than what it was reached from, whatever the order.
Drainage drain(glm::ivec2 samples, std::span<float> heights, std::span<const std::uint8_t> outlets, float least) {
    const auto [low, high] = std::ranges::minmax(heights);
    HeightQueue queue(low, high + 1.0F, heights.size());
    Drainage drainage;
    drainage.order.reserve(heights.size());
    drainage.receiver.assign(heights.size(), kNone);
    for (std::uint32_t k = 0; k < heights.size(); ++k) {
        if (outlets[k] == 0) continue;
        drainage.receiver[k] = k;
        queue.push(k, heights[k]);
    }
    for (std::uint32_t k = queue.pop(); k != kNone; k = queue.pop()) {
        drainage.order.push_back(k);
        forNeighbours(samples, k, [&](std::uint32_t n) {
            if (drainage.receiver[n] != kNone) return;
            drainage.receiver[n] = k;
            heights[n] = std::max(heights[n], heights[k] + least);
            queue.push(n, heights[n]);
        });
    }
    return drainage;
}

void erode(glm::ivec2 samples, std::span<float> heights, std::span<const std::uint8_t> outlets,
           std::span<const float> uplift, int rounds) {
    constexpr float kExponent = 0.3F; ///< of the area that a stream drains
    constexpr float kWear = 0.6F;     ///< of a stream that drains its own sample alone, in a round
    std::vector<float> area(heights.size());
    for (int round = 0; round < rounds; ++round) {
        const Drainage drainage = drain(samples, heights, outlets, 1e-3F);
        std::ranges::fill(area, 1.0F);
        for (auto k = drainage.order.rbegin(); k != drainage.order.rend(); ++k)
            if (drainage.receiver[*k] != *k) area[drainage.receiver[*k]] += area[*k];
        for (const std::uint32_t k : drainage.order) {
            const std::uint32_t to = drainage.receiver[k];
            if (to == k) continue;
            const float power = kWear * std::pow(area[k], kExponent);
            heights[k] = std::max(heights[to], (heights[k] + uplift[k] + power * heights[to]) / (1.0F + power));
        }
    }
}

} // namespace lumorph::navigation
