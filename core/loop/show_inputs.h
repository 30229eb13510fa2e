#pragma once

#include <mutex>
#include <string>
#include <vector>

namespace lumorph {

/// Something that was done to a show program: a key or button (1 pressed, 0 released) or a number, as it is.
struct ShowInput {
    std::string name;
    double value = 0.0;
    bool operator==(const ShowInput&) const = default;
};

/// Inputs on their way to a show program, in order. Wishes overtake one another and only the newest counts, so what
/// must arrive exactly once travels here: whoever has an input pushes it, from any thread, and the loop takes all of
/// them once a frame. A wish carries the queue by pointer; each program has a queue of its own.
class ShowInputs {
public:
    void push(ShowInput input);
    /// All that came since the last call, the oldest first.
    [[nodiscard]] std::vector<ShowInput> take();
    [[nodiscard]] bool empty() const;

private:
    mutable std::mutex mutex_;
    std::vector<ShowInput> waiting_;
};

} // namespace lumorph
