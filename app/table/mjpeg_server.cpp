#include "app/table/mjpeg_server.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <list>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <opencv2/imgcodecs.hpp>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "core/base/error.h"

namespace lumorph::table {

namespace {

constexpr double kExposure = 0.01; // seconds
constexpr int kQuality = 92;
constexpr std::chrono::milliseconds kPeriod{100};

bool say(int to, const std::string& text) {
    std::size_t sent = 0;
    while (sent < text.size()) {
        const ssize_t now = ::send(to, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
        if (now <= 0) return false;
        sent += static_cast<std::size_t>(now);
    }
    return true;
}

} // namespace

MjpegServer::MjpegServer(TableCamera& camera) : camera_(camera), socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    if (::bind(socket_, reinterpret_cast<sockaddr*>(&at), sizeof at) != 0 || ::listen(socket_, 4) != 0 ||
        ::getsockname(socket_, reinterpret_cast<sockaddr*>(&at), &size) != 0) {
        ::close(socket_);
        throw DeviceError("MJPEG camera of the table", "there is no free port", "end programs that hold ports");
    }
    port_ = ntohs(at.sin_port);
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

MjpegServer::~MjpegServer() {
    thread_.request_stop();
    thread_.join();
    ::close(socket_);
}

void MjpegServer::serve(const std::stop_token& stop) {
    struct Listener {
        std::atomic<bool> hasEnded{false};
        std::jthread thread;
    };
    std::list<Listener> listeners; // as many programs as want to see it
    while (!stop.stop_requested()) {
        pollfd one{socket_, POLLIN, 0};
        if (::poll(&one, 1, 50) <= 0) continue;
        const int listener = ::accept(socket_, nullptr, nullptr);
        if (listener < 0) continue;
        // One that asks for nothing, or does not read, must not keep the table from ending.
        const timeval patience{1, 0};
        ::setsockopt(listener, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        ::setsockopt(listener, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
        listeners.remove_if([](const Listener& past) { return past.hasEnded.load(); });
        Listener& its = listeners.emplace_back();
        its.thread = std::jthread([this, listener, &its](const std::stop_token& ends) {
            send(listener, ends);
            ::close(listener);
            its.hasEnded = true;
        });
    }
}

void MjpegServer::send(int listener, const std::stop_token& stop) {
    std::array<char, 4096> asked{};
    if (::recv(listener, asked.data(), asked.size(), 0) <= 0) return;
    if (!say(listener, "HTTP/1.1 200 OK\r\nCache-Control: no-store\r\n"
                       "Content-Type: multipart/x-mixed-replace; boundary=frame\r\n\r\n"))
        return;
    auto next = std::chrono::steady_clock::now();
    while (!stop.stop_requested()) {
        std::vector<std::uint8_t> jpeg;
        cv::imencode(".jpg", camera_.photograph(kExposure), jpeg, {cv::IMWRITE_JPEG_QUALITY, kQuality});
        std::this_thread::sleep_for(kLate);
        const std::string head =
            "--frame\r\nContent-Type: image/jpeg\r\nContent-Length: " + std::to_string(jpeg.size());
        if (!say(listener, head + "\r\n\r\n" + std::string(jpeg.begin(), jpeg.end()) + "\r\n")) return;
        next = std::max(next + kPeriod, std::chrono::steady_clock::now());
        std::this_thread::sleep_until(next);
    }
}

} // namespace lumorph::table
