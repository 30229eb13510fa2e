#include "app/table/gige_camera.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <arpa/inet.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <arv.h>
#include <opencv2/imgproc.hpp>

#include "core/base/error.h"

namespace lumorph::table {

namespace {

/// Microseconds in which a picture of so many pixels can be worked out on one core, with time to spare.
std::uint32_t framePeriod(guint32 width, guint32 height) {
    constexpr double kPixel = 0.076;
    constexpr double kShortest = 33'333.0; // 30 pictures a second
    return static_cast<std::uint32_t>(std::max(kShortest, kPixel * width * height));
}

/// 127.0.0.1 is there; others have to be given to the loopback, which only root may. Whether it took them shows when
/// the camera starts.
void addToLoopback(const std::string& host) {
    ifreq request{};
    const std::string alias = "lo:" + host.substr(host.rfind('.') + 1);
    alias.copy(request.ifr_name, IFNAMSIZ - 1);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    inet_pton(AF_INET, host.c_str(), &address.sin_addr);
    std::memcpy(&request.ifr_addr, &address, sizeof address);
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    if (socket < 0) return;
    ioctl(socket, SIOCSIFADDR, &request);
    ::close(socket);
}

} // namespace

struct GigeCamera::Data {
    TableCamera& camera;
    std::string host, serial;
    ArvGvFakeCamera* network = nullptr;

    /// In the camera's own thread.
    static void fill(ArvBuffer* buffer, void* self, guint32 exposure, guint32 gain, ArvPixelFormat /*format*/) {
        std::size_t none = 0; // it has no length before it is filled
        auto* to = static_cast<std::uint8_t*>(const_cast<void*>(arv_buffer_get_image_data(buffer, &none)));
        const int width = arv_buffer_get_image_width(buffer), height = arv_buffer_get_image_height(buffer);
        cv::Mat1b picture = static_cast<Data*>(self)->camera.photograph(1e-6 * exposure, gain);
        if (picture.cols != width || picture.rows != height) // the client has cut a part out
            picture = picture(cv::Rect(0, 0, std::min(width, picture.cols), std::min(height, picture.rows)));
        std::fill_n(to, width * height, std::uint8_t{0});
        for (int y = 0; y < picture.rows; ++y) std::copy_n(picture[y], picture.cols, to + y * width);
    }
    void plug() {
        if (host != "127.0.0.1") addToLoopback(host);
        network = arv_gv_fake_camera_new(host.c_str(), serial.c_str());
        if (!arv_gv_fake_camera_is_running(network)) {
            unplug();
            throw DeviceError("camera at " + host, "another program has the address, or the loopback has none of it",
                              "end the program that has it, or run: sudo ip address add " + host + "/8 dev lo");
        }
        ArvFakeCamera* sensor = arv_gv_fake_camera_get_fake_camera(network);
        const auto width = static_cast<guint32>(camera.size().width),
                   height = static_cast<guint32>(camera.size().height);
        arv_fake_camera_write_register(sensor, ARV_FAKE_CAMERA_REGISTER_SENSOR_WIDTH, width);
        arv_fake_camera_write_register(sensor, ARV_FAKE_CAMERA_REGISTER_SENSOR_HEIGHT, height);
        arv_fake_camera_write_register(sensor, ARV_FAKE_CAMERA_REGISTER_WIDTH, width);
        arv_fake_camera_write_register(sensor, ARV_FAKE_CAMERA_REGISTER_HEIGHT, height);
        arv_fake_camera_write_register(sensor, ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US,
                                       framePeriod(width, height));
        arv_fake_camera_set_fill_pattern(sensor, &Data::fill, this);
    }
    void unplug() {
        if (network != nullptr) g_object_unref(network);
        network = nullptr;
    }
};

GigeCamera::GigeCamera(TableCamera& camera, const std::string& host, const std::string& serial)
    : data_(new Data{camera, host, serial}) {
    data_->plug();
}

GigeCamera::~GigeCamera() { data_->unplug(); }

std::string GigeCamera::address() const { return "genicam://Aravis-Fake-" + data_->serial; }

void GigeCamera::setPlugged(bool plugged) {
    if (plugged == (data_->network != nullptr)) return;
    plugged ? data_->plug() : data_->unplug();
}

TableCamera& GigeCamera::sensor() const { return data_->camera; }

void GigeCamera::losePackets(double share) {
    if (data_->network != nullptr) g_object_set(data_->network, "gvsp-lost-ratio", share, nullptr);
}

} // namespace lumorph::table
