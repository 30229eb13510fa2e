#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include <QObject>

namespace lumorph::test {

/// The longest time an event had to wait for the window's thread, as a thread beside it sees it. What the hypervisor
/// took away from a processor meanwhile (/proc/stat's "steal") is not the window's and does not count.
class StallWatch {
public:
    StallWatch();
    ~StallWatch();
    /// Milliseconds since the start or the last call.
    [[nodiscard]] double takeLongest();

private:
    struct Ping;
    std::unique_ptr<QObject> receiver_;
    std::atomic<bool> answered_{true};
    std::atomic<double> longest_{0.0};
    std::jthread thread_;
};

} // namespace lumorph::test
