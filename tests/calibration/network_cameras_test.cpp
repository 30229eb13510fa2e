#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <arv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "calibration/capture/capture_camera.h"
#include "calibration/capture/genicam_camera.h"
#include "core/base/error.h"

// Cameras that are reached by packets alone: a telephone that sends MJPEG, and GigE Vision on the loopback.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

const cv::Size kSize(320, 240);

std::string jpegOf(int grey) {
    std::vector<std::uint8_t> bytes;
    cv::imencode(".jpg", cv::Mat(kSize, CV_8U, cv::Scalar(grey)), bytes);
    return {bytes.begin(), bytes.end()};
}

int greyIn(const cv::Mat& picture) { return static_cast<int>(cv::mean(greyOf(picture))[0] + 0.5); }

/// What a camera's server says.
struct Telephone {
    std::string answer = "HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace;boundary=cut\r\n\r\n";
    bool saysLength = true;
    bool sendsPictures = true;
    std::function<std::string(int grey)> picture = jpegOf;
    std::chrono::milliseconds late = 0ms; ///< from the light to the first byte
};

/// A server for one listener at a time; sends the grey of `late` ago, 50 times a second.
class MjpegServer {
public:
    explicit MjpegServer(Telephone telephone) : telephone_(std::move(telephone)) {
        socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in at{};
        at.sin_family = AF_INET;
        at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof at;
        EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&at), sizeof at), 0);
        EXPECT_EQ(::listen(socket_, 4), 0);
        EXPECT_EQ(::getsockname(socket_, reinterpret_cast<sockaddr*>(&at), &size), 0);
        port_ = ntohs(at.sin_port);
        thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
    }
    ~MjpegServer() {
        thread_.request_stop();
        thread_.join();
        ::close(socket_);
    }
    MjpegServer(const MjpegServer&) = delete;
    MjpegServer& operator=(const MjpegServer&) = delete;

    [[nodiscard]] std::string address() const { return "http://127.0.0.1:" + std::to_string(port_) + "/video"; }
    void setGrey(int grey) {
        const std::lock_guard lock(mutex_);
        greys_.emplace_back(Clock::now(), grey);
    }
    [[nodiscard]] std::string request() {
        const std::lock_guard lock(mutex_);
        return request_;
    }
    void hangUp() { hangUp_ = true; }

private:
    using Clock = std::chrono::steady_clock;

    int greyNow() {
        const std::lock_guard lock(mutex_);
        int grey = 0;
        for (const auto& [since, value] : greys_)
            if (since + telephone_.late <= Clock::now()) grey = value;
        return grey;
    }
    static bool say(int to, const std::string& text) {
        return ::send(to, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
    }
    void serve(const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            pollfd one{socket_, POLLIN, 0};
            if (::poll(&one, 1, 20) <= 0) continue;
            const int listener = ::accept(socket_, nullptr, nullptr);
            std::array<char, 4096> asked{};
            const ssize_t got = ::recv(listener, asked.data(), asked.size(), 0);
            {
                const std::lock_guard lock(mutex_);
                request_.assign(asked.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
            }
            hangUp_ = false;
            bool hears = say(listener, telephone_.answer);
            while (hears && telephone_.sendsPictures && !hangUp_ && !stop.stop_requested()) {
                const std::string picture = telephone_.picture(greyNow());
                std::string head = "--cut\r\nContent-Type: image/jpeg\r\n";
                if (telephone_.saysLength) head += "Content-Length: " + std::to_string(picture.size()) + "\r\n";
                hears = say(listener, head + "\r\n" + picture + "\r\n");
                std::this_thread::sleep_for(20ms);
            }
            while (!telephone_.sendsPictures && !hangUp_ && !stop.stop_requested() && telephone_.answer.empty())
                std::this_thread::sleep_for(10ms); // connected, and silent
            ::close(listener);
        }
    }

    Telephone telephone_;
    int socket_ = -1;
    int port_ = 0;
    std::mutex mutex_;
    std::vector<std::pair<Clock::time_point, int>> greys_{{Clock::time_point(), 10}};
    std::string request_;
    std::atomic<bool> hangUp_{false};
    std::jthread thread_;
};

class MjpegCameraTest : public testing::TestWithParam<bool> {};

TEST_P(MjpegCameraTest, GivesWhatWasLitAfterTheCallThoughItComesLate) {
    Telephone telephone;
    telephone.saysLength = GetParam();
    telephone.late = 100ms;
    MjpegServer server(telephone);
    const auto camera = openCaptureCamera(server.address());
    EXPECT_NEAR(greyIn(camera->grab({})), 10, 2);
    for (const int grey : {200, 60, 130}) {
        server.setGrey(grey);
        EXPECT_NEAR(greyIn(camera->grab({})), grey, 2);
    }
    EXPECT_EQ(camera->size(), kSize);
    EXPECT_FALSE(camera->exposures());
    EXPECT_THAT(camera->automatics().front(), HasSubstr("Lock them"));
    EXPECT_THAT(server.request(), HasSubstr("GET /video HTTP/1."));
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutLengths, MjpegCameraTest, testing::Bool());

TEST(MjpegCamera, ComesBackAfterItWasGone) {
    MjpegServer server({});
    const auto camera = openCaptureCamera(server.address());
    EXPECT_NEAR(greyIn(camera->grab({})), 10, 2);
    server.hangUp();
    server.setGrey(90);
    EXPECT_NEAR(greyIn(camera->grab({})), 90, 2);
}

TEST(MjpegCamera, NameAndPasswordGoToTheCameraAndIntoNoMessage) {
    Telephone telephone;
    telephone.answer = "HTTP/1.1 401 Unauthorized\r\nContent-Type: text/html\r\n\r\n";
    telephone.sendsPictures = false;
    MjpegServer server(telephone);
    const std::string host = server.address().substr(7);
    const auto camera = openCaptureCamera("http://anna:secret@" + host);
    EXPECT_EQ(camera->name(), server.address());
    try {
        (void)camera->grab({});
        FAIL();
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), HasSubstr("a name and a password"));
        EXPECT_THAT(error.what(), testing::Not(HasSubstr("secret")));
    }
    EXPECT_THAT(server.request(), HasSubstr("Authorization: Basic YW5uYTpzZWNyZXQ=\r\n")); // by base64(1)
}

TEST(MjpegCamera, WhatIsWrongIsSaid) {
    const auto said = [](const std::string& address) -> std::string {
        try {
            (void)openCaptureCamera(address)->grab({});
        } catch (const DeviceError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(said("http://127.0.0.1:1/video"), HasSubstr("refuses"));
    EXPECT_THAT(said("http://127.0.0.1:99999/"), HasSubstr("port"));
    EXPECT_THAT(said("http:///video"), HasSubstr("no host"));
    Telephone page;
    page.answer = "HTTP/1.1 200 OK\r\nContent-Type: text/html\r\n\r\n<html>";
    page.sendsPictures = false;
    EXPECT_THAT(said(MjpegServer(page).address()), HasSubstr("text/html"));
    Telephone garbage;
    garbage.picture = [](int) { return std::string("\xff\xd8 no picture at all"); };
    MjpegServer server(garbage);
    EXPECT_THAT(said(server.address()), HasSubstr("cannot be read as JPEG"));
}

TEST(MjpegCamera, WaitingForOneThatIsSilentEndsAtOnce) {
    Telephone silent;
    silent.answer.clear();
    silent.sendsPictures = false;
    MjpegServer server(silent);
    const auto camera = openCaptureCamera(server.address());
    std::stop_source stop;
    std::jthread cancels([&] {
        std::this_thread::sleep_for(200ms);
        stop.request_stop();
    });
    const auto begun = std::chrono::steady_clock::now();
    EXPECT_THROW((void)camera->grab(Progress({}, stop.get_token())), Cancelled);
    EXPECT_LT(std::chrono::steady_clock::now() - begun, 700ms);
}

/// A GigE Vision camera at an address of the loopback, whose pixels are its exposure in units of 100 microseconds.
class GigeCamera {
public:
    explicit GigeCamera(const char* serial) : camera_(arv_gv_fake_camera_new("127.0.0.1", serial)) {
        arv_fake_camera_set_fill_pattern(arv_gv_fake_camera_get_fake_camera(camera_), &GigeCamera::fill, this);
    }
    ~GigeCamera() { g_object_unref(camera_); }
    GigeCamera(const GigeCamera&) = delete;
    GigeCamera& operator=(const GigeCamera&) = delete;

    [[nodiscard]] bool isRunning() const { return arv_gv_fake_camera_is_running(camera_) != FALSE; }
    std::atomic<int> light{1}; ///< by which each pixel is multiplied

private:
    static void fill(ArvBuffer* buffer, void* self, guint32 exposure, guint32 /*gain*/, ArvPixelFormat /*format*/) {
        std::size_t none = 0; // it has no length before it is filled
        auto* pixels = static_cast<std::uint8_t*>(const_cast<void*>(arv_buffer_get_image_data(buffer, &none)));
        const int size = arv_buffer_get_image_width(buffer) * arv_buffer_get_image_height(buffer);
        const int value = static_cast<GigeCamera*>(self)->light * static_cast<int>(exposure) / 100;
        std::fill_n(pixels, size, static_cast<std::uint8_t>(std::min(value, 255)));
    }

    ArvGvFakeCamera* camera_;
};

TEST(GenicamCamera, IsFoundBySerialNumberExposesAsItIsToldAndGivesWhatWasLitAfterTheCall) {
    GigeCamera real("LUM7");
    ASSERT_TRUE(real.isRunning());
    std::string address;
    for (const CameraInfo& info : listGenicamCameras())
        if (info.name.find("LUM7") != std::string::npos) address = info.path;
    ASSERT_THAT(address, HasSubstr("genicam://"));
    ASSERT_THAT(address, HasSubstr("LUM7"));
    const auto camera = openCaptureCamera(address);
    EXPECT_EQ(camera->size(), cv::Size(2048, 2048)) << "all of its sensor";
    ASSERT_TRUE(camera->exposures());
    camera->setExposure(0.004);
    EXPECT_EQ(greyIn(camera->grab({})), 40);
    for (const int light : {3, 1, 2}) {
        real.light = light;
        EXPECT_EQ(greyIn(camera->grab({})), 40 * light);
    }
    camera->setExposure(0.008);
    (void)camera->grab({}); // one that was being exposed
    EXPECT_EQ(greyIn(camera->grab({})), 160);
}

TEST(GenicamCamera, OneThatIsNotThereIsSaid) {
    try {
        (void)openCaptureCamera("genicam://Nobody-1");
        FAIL();
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), HasSubstr("is not there"));
    }
}

} // namespace
} // namespace lumorph::test
