#pragma once

#include <functional>
#include <memory>
#include <thread>

#include "devices/transport/discovery.h"

namespace lumorph {

/// One look around by Bluetooth, under way while it lives. Made, used and destroyed in one thread that runs a Qt event
/// loop; each of these may wait half a minute for a Bluetooth service that hangs.
class BluetoothScan {
public:
    virtual ~BluetoothScan() = default;
};

/// Looks for Bluetooth devices that offer a serial port, in a thread of its own: whoever asks never waits for the
/// Bluetooth service. Lives in one thread that runs a Qt event loop, in which its events come; they must not destroy
/// it. Gone, it calls no more.
class BluetoothSearch {
public:
    struct Events {
        std::function<void(const FoundDevice&)> found;
        std::function<void(const LinkTrouble&)> ended; ///< texts are empty where it simply came to its end
    };
    /// Begins a scan, or tells its end at once and gives null. Its events are called in the thread that it is called
    /// in.
    using Begin = std::function<std::unique_ptr<BluetoothScan>(Events)>;

    explicit BluetoothSearch(Events events);
    /// For tests, which have no Bluetooth.
    BluetoothSearch(Events events, Begin begin);
    /// A scan that waits for the Bluetooth service is left behind and ends when it can.
    ~BluetoothSearch();
    BluetoothSearch(const BluetoothSearch&) = delete;
    BluetoothSearch& operator=(const BluetoothSearch&) = delete;

    /// Begins to look around, which takes ten seconds or so; nothing happens where that is under way.
    void start();
    [[nodiscard]] bool running() const noexcept;

private:
    struct Data;
    std::shared_ptr<Data> data_; ///< the thread's too, so that it may be left behind
    std::thread thread_;         ///< one for all scans: Qt keeps objects of its own in the thread of the first
};

} // namespace lumorph
