#pragma once

#include <memory>
#include <string>

#include "app/table/table_camera.h"

namespace lumorph::table {

/// A camera of the table as a GigE Vision camera on the loopback (Aravis' ArvGvFakeCamera): found, told its exposure
/// and gain, and read as a real one. Its clock and its packets are its own.
class GigeCamera {
public:
    /// `host` is an address of the loopback for it alone: two at one address answer for each other. Throws DeviceError
    /// where that is taken.
    GigeCamera(TableCamera& camera, const std::string& host, const std::string& serial);
    ~GigeCamera();
    GigeCamera(const GigeCamera&) = delete;
    GigeCamera& operator=(const GigeCamera&) = delete;

    /// As the studio opens it.
    [[nodiscard]] std::string address() const;
    /// Takes it from the network, and puts it back.
    void setPlugged(bool plugged);
    [[nodiscard]] TableCamera& sensor() const;
    /// Of its packets with pictures, so many are lost on their way; 0 to 1.
    void losePackets(double share);

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::table
