#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
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
#include "tests/core/temporary_folder.h"

// Cameras that are reached by packets alone: a telephone that sends MJPEG, and GigE Vision on the loopback.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

const cv::Size kSize(320, 240);

std::string jpegOf(int grey, cv::Size size) {
    std::vector<std::uint8_t> bytes;
    cv::imencode(".jpg", cv::Mat(size, CV_8U, cv::Scalar(grey)), bytes);
    return {bytes.begin(), bytes.end()};
}

int greyIn(const cv::Mat& picture) { return static_cast<int>(cv::mean(greyOf(picture))[0] + 0.5); }

/// What a camera's server says.
struct Telephone {
    std::string answer = "HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace;boundary=cut\r\n\r\n";
    bool saysLength = true;
    bool sendsPictures = true;
    std::function<std::string(int grey)> picture = [](int grey) { return jpegOf(grey, kSize); };
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
    Telephone stamp;
    stamp.picture = [](int grey) { return jpegOf(grey, {8, 8}); };
    MjpegServer tiny(stamp);
    EXPECT_THAT(said(tiny.address()), HasSubstr("8 x 8 pixels"));
}

TEST(MjpegCamera, SixteenMegapixelsAreRead) {
    Telephone large;
    const std::string once = jpegOf(77, {4608, 3456});
    large.picture = [&](int) { return once; };
    MjpegServer server(large);
    const auto camera = openCaptureCamera(server.address());
    EXPECT_NEAR(greyIn(camera->grab({})), 77, 2);
    EXPECT_EQ(camera->size(), cv::Size(4608, 3456));
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

/// What a GigE Vision camera is.
struct GigeFacts {
    const char* serial = "LUM7";
    cv::Size sensor{2048, 2048};
    std::chrono::microseconds period = 40ms;
    /// Its only pixel format, by the name and number of the standard PFNC; empty: the fake camera's own.
    std::string format{};
    ArvPixelFormat number = 0;
};

/// A GigE Vision camera at an address of the loopback, whose pixels are its exposure in units of 100 microseconds, in
/// the bits of its format.
class GigeCamera {
public:
    explicit GigeCamera(const GigeFacts& facts) {
        const std::filesystem::path described = folder_ / "camera.xml";
        if (!facts.format.empty()) std::ofstream(described) << description(facts);
        camera_ =
            arv_gv_fake_camera_new_full("127.0.0.1", facts.serial, facts.format.empty() ? nullptr : described.c_str());
        ArvFakeCamera* sensor = arv_gv_fake_camera_get_fake_camera(camera_);
        const auto set = [&](guint64 at, auto value) {
            arv_fake_camera_write_register(sensor, static_cast<guint32>(at), static_cast<guint32>(value));
        };
        set(ARV_FAKE_CAMERA_REGISTER_SENSOR_WIDTH, facts.sensor.width);
        set(ARV_FAKE_CAMERA_REGISTER_SENSOR_HEIGHT, facts.sensor.height);
        set(ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US, facts.period.count());
        if (facts.number != 0) set(ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT, facts.number);
        arv_fake_camera_set_fill_pattern(sensor, &GigeCamera::fill, this);
    }
    ~GigeCamera() { g_object_unref(camera_); }
    GigeCamera(const GigeCamera&) = delete;
    GigeCamera& operator=(const GigeCamera&) = delete;

    [[nodiscard]] bool isRunning() const { return arv_gv_fake_camera_is_running(camera_) != FALSE; }
    std::atomic<int> light{1}; ///< by which each pixel is multiplied

private:
    /// What the fake camera says of itself, with one pixel format in place of its own.
    static std::string description(const GigeFacts& facts) {
        ArvFakeCamera* plain = arv_fake_camera_new(facts.serial);
        std::size_t size = 0;
        const char* own = arv_fake_camera_get_genicam_xml(plain, &size);
        std::string text(own, size);
        g_object_unref(plain);
        const std::size_t list = text.find("<Enumeration Name=\"PixelFormat\"");
        const std::size_t first = text.find("<EnumEntry", list), end = text.find("</Enumeration>", list);
        const std::size_t last = text.rfind("</EnumEntry>", end) + std::string_view("</EnumEntry>").size();
        return text.replace(first, last - first,
                            "<EnumEntry Name=\"" + facts.format + "\" NameSpace=\"Standard\"><Value>" +
                                std::to_string(facts.number) + "</Value></EnumEntry>");
    }
    static void fill(ArvBuffer* buffer, void* self, guint32 exposure, guint32 /*gain*/, ArvPixelFormat format) {
        std::size_t none = 0; // it has no length before it is filled
        void* pixels = const_cast<void*>(arv_buffer_get_image_data(buffer, &none));
        const int size = arv_buffer_get_image_width(buffer) * arv_buffer_get_image_height(buffer);
        const int value = std::min(static_cast<GigeCamera*>(self)->light * static_cast<int>(exposure) / 100, 255);
        if (format == ARV_PIXEL_FORMAT_MONO_12)
            std::fill_n(static_cast<std::uint16_t*>(pixels), size, static_cast<std::uint16_t>(16 * value));
        else
            std::fill_n(static_cast<std::uint8_t*>(pixels), size, static_cast<std::uint8_t>(value));
    }

    TemporaryFolder folder_;
    ArvGvFakeCamera* camera_ = nullptr;
};

TEST(GenicamCamera, IsFoundBySerialNumberExposesAsItIsToldAndGivesWhatWasLitAfterTheCall) {
    GigeCamera real({});
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

TEST(GenicamCamera, OtherPixelFormatsAreReadAsTheyAreMeant) {
    struct Case {
        const char* name;
        ArvPixelFormat number;
        int channels;
    };
    for (const Case& one :
         {Case{"Mono12", ARV_PIXEL_FORMAT_MONO_12, 1}, Case{"BayerRG8", ARV_PIXEL_FORMAT_BAYER_RG_8, 3}}) {
        GigeCamera real({.sensor = {640, 480}, .format = one.name, .number = one.number});
        ASSERT_TRUE(real.isRunning());
        const auto camera = openCaptureCamera("genicam://Aravis-Fake-LUM7");
        camera->setExposure(0.008);
        (void)camera->grab({});
        const cv::Mat picture = camera->grab({});
        EXPECT_EQ(picture.channels(), one.channels) << one.name;
        EXPECT_NEAR(greyIn(picture), 80, 1) << one.name;
        EXPECT_EQ(picture.size(), cv::Size(640, 480)) << one.name;
    }
}

TEST(GenicamCamera, SixteenMegapixelsAreReadOrToldToArriveIncomplete) {
    GigeCamera real({.sensor = {4096, 4096}, .period = 500ms});
    const auto camera = openCaptureCamera("genicam://Aravis-Fake-LUM7");
    try {
        EXPECT_EQ(camera->grab({}).size(), cv::Size(4096, 4096));
    } catch (const DeviceError& error) { // a busy machine loses packets of so large a burst
        EXPECT_THAT(error.what(), HasSubstr("arrive incomplete"));
    }
}

TEST(GenicamCamera, WhatIsTooSmallOrOfNoKnownFormatIsSaid) {
    const auto said = [](const GigeFacts& facts) -> std::string {
        const GigeCamera real(facts);
        try {
            (void)openCaptureCamera("genicam://Aravis-Fake-LUM7");
        } catch (const DeviceError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(said({.sensor = {8, 8}}), HasSubstr("8 x 8 pixels"));
    EXPECT_THAT(said({.format = "Coord3D_C16", .number = ARV_PIXEL_FORMAT_COORD3D_C_16}), HasSubstr("no pixel format"));
}

TEST(GenicamCamera, WaitingForOneFrameAMinuteEndsAtOnce) {
    GigeCamera real({.sensor = {640, 480}, .period = 60s});
    const auto camera = openCaptureCamera("genicam://Aravis-Fake-LUM7");
    std::stop_source stop;
    std::jthread cancels([&] {
        std::this_thread::sleep_for(200ms);
        stop.request_stop();
    });
    const auto begun = std::chrono::steady_clock::now();
    EXPECT_THROW((void)camera->grab(Progress({}, stop.get_token())), Cancelled);
    EXPECT_LT(std::chrono::steady_clock::now() - begun, 700ms);
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
