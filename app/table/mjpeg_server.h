#pragma once

#include <chrono>
#include <string>
#include <thread>

#include "app/table/table_camera.h"

namespace lumorph::table {

/// A camera of the table as a telephone or network camera sends it: MJPEG over HTTP (multipart/x-mixed-replace) at a
/// port of the loopback that the system chooses. Its exposure is its own; pictures come `kLate` late.
class MjpegServer {
public:
    static constexpr std::chrono::milliseconds kLate{60};

    /// `camera` outlives it. Throws DeviceError where there is no port.
    explicit MjpegServer(TableCamera& camera);
    ~MjpegServer();
    MjpegServer(const MjpegServer&) = delete;
    MjpegServer& operator=(const MjpegServer&) = delete;

    [[nodiscard]] std::string address() const { return "http://127.0.0.1:" + std::to_string(port_) + "/lumorph-table"; }

private:
    void serve(const std::stop_token& stop);
    void send(int listener, const std::stop_token& stop);

    TableCamera& camera_;
    int socket_ = -1;
    int port_ = 0;
    std::jthread thread_;
};

} // namespace lumorph::table
