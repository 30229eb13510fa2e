#include "calibration/capture/mjpeg_camera.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>
#include <vector>

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <opencv2/imgcodecs.hpp>

#include "core/base/clock.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

using namespace std::chrono_literals;

constexpr std::string_view kHttp = "http://";
constexpr Microseconds kLate{400'000};
constexpr auto kAnew = 500ms;                            ///< until it connects again
constexpr auto kPictureWithin = 10s;                     ///< for a picture
constexpr auto kWantedEvery = 50ms;                      ///< between looks at whether it is still wanted
constexpr std::size_t kMostHead = std::size_t{1} << 16U; ///< bytes
constexpr std::size_t kMostPicture = std::size_t{64} << 20U;
constexpr int kMostBroken = 5; ///< pictures one after the other

struct HttpAddress {
    std::string host, port = "80", path = "/", user; ///< user: "name:password", or empty
};

HttpAddress parseAddress(const std::string& address) {
    const auto bad = [&](const char* why) {
        return DeviceError("camera " + address, why, "give it as http://192.168.0.7:8080/video");
    };
    if (!isMjpegAddress(address)) throw bad("is no address of a network camera");
    HttpAddress parsed;
    std::string rest = address.substr(kHttp.size());
    if (const std::size_t slash = rest.find('/'); slash != std::string::npos) {
        parsed.path = rest.substr(slash);
        rest.resize(slash);
    }
    if (const std::size_t at = rest.rfind('@'); at != std::string::npos) {
        parsed.user = rest.substr(0, at);
        rest.erase(0, at + 1);
    }
    if (rest.starts_with('[')) { // IPv6
        const std::size_t end = rest.find(']');
        if (end == std::string::npos) throw bad("has a [ without ]");
        parsed.host = rest.substr(1, end - 1);
        rest.erase(0, end + 1);
    } else {
        const std::size_t colon = rest.find(':');
        parsed.host = rest.substr(0, colon);
        rest.erase(0, parsed.host.size());
    }
    if (!rest.empty()) parsed.port = rest.substr(1);
    int port = 0;
    const auto [end, error] = std::from_chars(parsed.port.data(), parsed.port.data() + parsed.port.size(), port);
    if (error != std::errc() || end != parsed.port.data() + parsed.port.size() || port < 1 || port > 65535)
        throw bad("has a port that is none");
    if (parsed.host.empty()) throw bad("names no host");
    if (parsed.path.find_first_of("\r\n ") != std::string::npos) throw bad("has a blank in it");
    return parsed;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three = three << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? kDigits[three >> (18U - 6U * k) & 63U] : '=';
    }
    return text;
}

std::string lowerCase(std::string_view text) {
    std::string lower(text);
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return lower;
}

/// The value of a head's line, such as "content-length"; empty: it has none.
std::string headValue(std::string_view head, std::string_view name) {
    const std::string lower = lowerCase(head);
    const std::size_t at = lower.find("\n" + std::string(name) + ":");
    if (at == std::string::npos) return {};
    std::string_view value = head.substr(at + name.size() + 2);
    value = value.substr(0, value.find_first_of("\r\n"));
    while (!value.empty() && value.front() == ' ') value.remove_prefix(1);
    return std::string(value);
}

/// A socket that gives up where nobody waits for it any more.
class Connection {
public:
    explicit Connection(const std::atomic<bool>& unwanted) : unwanted_(unwanted) {}
    ~Connection() { close(); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Why not, or empty.
    std::string open(const HttpAddress& address) {
        close();
        addrinfo wish{};
        wish.ai_socktype = SOCK_STREAM;
        addrinfo* found = nullptr;
        if (::getaddrinfo(address.host.c_str(), address.port.c_str(), &wish, &found) != 0)
            return "its host is not known in this network";
        std::string why = "nobody answers there";
        for (const addrinfo* one = found; one && socket_ < 0; one = one->ai_next)
            if (!connectTo(*one)) why = errno == ECONNREFUSED ? "it refuses the connection" : "nobody answers there";
        ::freeaddrinfo(found);
        return socket_ < 0 ? why : std::string();
    }
    bool send(std::string_view text) const {
        while (!text.empty()) {
            if (!waitFor(POLLOUT, kPictureWithin)) return false;
            const ssize_t sent = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
            if (sent <= 0) return false;
            text.remove_prefix(static_cast<std::size_t>(sent));
        }
        return true;
    }
    /// Appends what has come; false at the end, or when nothing comes.
    bool receive(std::string& buffer) const {
        if (!waitFor(POLLIN, kPictureWithin)) return false;
        std::array<char, 65536> bytes; // NOLINT(cppcoreguidelines-pro-type-member-init): written before it is read
        const ssize_t got = ::recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT);
        if (got <= 0) return false;
        buffer.append(bytes.data(), static_cast<std::size_t>(got));
        return true;
    }

private:
    bool connectTo(const addrinfo& to) {
        socket_ = ::socket(to.ai_family, to.ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, to.ai_protocol);
        if (socket_ < 0) return false;
        int error = ::connect(socket_, to.ai_addr, to.ai_addrlen) == 0 ? 0 : errno;
        if (error == EINPROGRESS) {
            socklen_t size = sizeof error;
            error = ETIMEDOUT;
            if (waitFor(POLLOUT, 5s)) ::getsockopt(socket_, SOL_SOCKET, SO_ERROR, &error, &size);
        }
        if (error == 0) return true;
        close();
        errno = error;
        return false;
    }
    bool waitFor(short events, std::chrono::milliseconds atMost) const {
        for (auto waited = 0ms; waited < atMost && !unwanted_; waited += kWantedEvery) {
            pollfd one{socket_, events, 0};
            if (::poll(&one, 1, static_cast<int>(kWantedEvery.count())) > 0) return true;
        }
        return false;
    }
    void close() {
        if (socket_ >= 0) ::close(std::exchange(socket_, -1));
    }

    const std::atomic<bool>& unwanted_;
    int socket_ = -1;
};

/// What the reading thread and the camera share: the thread outlives a camera that nobody waits for any more, as a
/// name may take long to be found.
struct Shared {
    std::atomic<bool> unwanted{false};
    std::mutex mutex;
    std::condition_variable came;
    // Guarded by the mutex.
    std::string picture;   ///< the newest, as it was sent
    Microseconds began{0}; ///< when its first byte was there
    std::uint64_t count = 0;
    std::string why; ///< nothing comes, in a few words; empty: it does
};

/// Reads the parts of one answer until it ends; returns why.
class Reader {
public:
    Reader(const HttpAddress& address, Shared& shared)
        : address_(address), shared_(shared), connection_(shared.unwanted) {}

    std::string read() {
        if (std::string why = connection_.open(address_); !why.empty()) return why;
        std::string request = "GET " + address_.path + " HTTP/1.0\r\nHost: " + address_.host +
                              "\r\nUser-Agent: Lumorph\r\nAccept: multipart/x-mixed-replace, image/jpeg\r\n";
        if (!address_.user.empty()) request += "Authorization: Basic " + base64(address_.user) + "\r\n";
        if (!connection_.send(request + "\r\n")) return "it does not take a request";
        const std::optional<std::string> head = takeHead();
        if (!head) return "it does not answer as HTTP does";
        if (std::string why = refusalOf(*head); !why.empty()) return why;
        while (!shared_.unwanted)
            if (!takePart()) break;
        return shared_.count == 0 ? "it sends no MJPEG" : "its pictures have ended";
    }

private:
    static std::string refusalOf(std::string_view head) {
        const std::size_t blank = head.find(' ');
        const std::string_view code = blank == std::string_view::npos ? head : head.substr(blank + 1, 3);
        if (!head.starts_with("HTTP/")) return "it does not answer as HTTP does";
        if (code == "401" || code == "403") return "it wants a name and a password";
        if (code == "404") return "it has nothing under this path";
        if (code != "200") return "it answers " + std::string(code);
        const std::string type = lowerCase(headValue(head, "content-type"));
        if (!type.starts_with("multipart/")) return "it sends " + (type.empty() ? "no MJPEG" : type + ", no MJPEG");
        return {};
    }

    /// Up to the empty line, which is taken too.
    std::optional<std::string> takeHead() {
        while (true) {
            for (const std::string_view end : {"\r\n\r\n", "\n\n"})
                if (const std::size_t at = buffer_.find(end); at != std::string::npos) {
                    std::string head = buffer_.substr(0, at + 1);
                    buffer_.erase(0, at + end.size());
                    return head;
                }
            if (buffer_.size() > kMostHead || !connection_.receive(buffer_)) return std::nullopt;
        }
    }

    /// A boundary, the part's own head, and the picture.
    bool takePart() {
        while (buffer_.find("--") == std::string::npos)
            if (buffer_.size() > kMostHead || !connection_.receive(buffer_)) return false;
        const Microseconds began = clock_.now();
        buffer_.erase(0, buffer_.find("--")); // an empty line before it would end its head
        const std::optional<std::string> head = takeHead();
        if (!head) return false;
        const std::string told = headValue("\n" + *head, "content-length");
        std::size_t size = 0;
        const auto [end, error] = std::from_chars(told.data(), told.data() + told.size(), size);
        const bool isTold = !told.empty() && error == std::errc();
        if (isTold && size > kMostPicture) return false;
        const std::string boundary = boundaryOf(*head);
        std::size_t sought = 0;
        while (isTold ? buffer_.size() < size : (size = buffer_.find(boundary, sought)) == std::string::npos) {
            sought = buffer_.size() > boundary.size() ? buffer_.size() - boundary.size() : 0;
            if (buffer_.size() > kMostPicture || !connection_.receive(buffer_)) return false;
        }
        {
            const std::lock_guard lock(shared_.mutex);
            shared_.picture = buffer_.substr(0, size);
            shared_.began = began;
            shared_.why.clear();
            ++shared_.count;
        }
        shared_.came.notify_all();
        buffer_.erase(0, size);
        return true;
    }

    /// The line before a part, which comes again after it.
    static std::string boundaryOf(const std::string& head) {
        const std::size_t at = head.find("--");
        return "\r\n" + head.substr(at, head.find_first_of("\r\n", at) - at);
    }

    const HttpAddress& address_;
    Shared& shared_;
    Connection connection_;
    std::string buffer_;
    SteadyClock clock_;
};

void readForEver(const HttpAddress& address, const std::shared_ptr<Shared>& shared) {
    while (!shared->unwanted) {
        const std::string why = Reader(address, *shared).read();
        {
            const std::lock_guard lock(shared->mutex);
            shared->why = why;
        }
        shared->came.notify_all();
        for (auto waited = 0ms; waited < kAnew && !shared->unwanted; waited += kWantedEvery)
            std::this_thread::sleep_for(kWantedEvery);
    }
}

class MjpegCamera final : public CaptureCamera {
public:
    explicit MjpegCamera(const std::string& address) : name_(withoutPassword(address)) {
        std::thread([parsed = parseAddress(address), shared = shared_] { readForEver(parsed, shared); }).detach();
    }
    ~MjpegCamera() override { shared_->unwanted = true; }

    [[nodiscard]] cv::Mat grab(const Progress& progress) override {
        const Microseconds called = clock_.now();
        for (int broken = 0; broken < kMostBroken; ++broken)
            if (cv::Mat picture = decoded(next(called + kLate, progress)); !picture.empty()) {
                requireReadable(name_, size_ = picture.size());
                return picture;
            }
        throw unreadable();
    }
    [[nodiscard]] std::string name() const override { return name_; }
    [[nodiscard]] cv::Size size() const override { return size_; }
    [[nodiscard]] std::vector<std::string> automatics() const override {
        return {"Whether exposure, white balance and focus of " + name_ +
                " change by themselves cannot be told from here. Lock them in its own settings."};
    }

private:
    static std::string withoutPassword(const std::string& address) {
        const std::size_t at = address.rfind('@');
        return at == std::string::npos ? address : std::string(kHttp) + address.substr(at + 1);
    }
    [[nodiscard]] DeviceError unreadable() const {
        return {"camera " + name_, "its pictures cannot be read as JPEG", "choose MJPEG in its settings"};
    }
    static cv::Mat decoded(const std::string& jpeg) {
        if (jpeg.empty()) return {};
        try {
            const cv::Mat bytes(1, static_cast<int>(jpeg.size()), CV_8U,
                                const_cast<char*>(jpeg.data())); // NOLINT: read
            return cv::imdecode(bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
        } catch (const cv::Exception&) {
            return {};
        }
    }

    /// The newest picture that began at this time or later, and after the one given before.
    std::string next(Microseconds from, const Progress& progress) {
        const auto until = std::chrono::steady_clock::now() + kPictureWithin;
        std::unique_lock lock(shared_->mutex);
        while (true) {
            if (shared_->count > given_ && shared_->began >= from) {
                given_ = shared_->count;
                return shared_->picture;
            }
            const bool hasFailed = shared_->count == 0 && !shared_->why.empty(); // later it may come back
            if (hasFailed || std::chrono::steady_clock::now() >= until)
                throw DeviceError("camera " + name_,
                                  shared_->why.empty() ? "sends no picture within 10 seconds" : shared_->why,
                                  "open the address in a browser, and see whether it shows the picture there");
            shared_->came.wait_for(lock, kWantedEvery);
            if (!progress.cancelled()) continue;
            lock.unlock();
            progress.throwIfCancelled();
        }
    }

    std::string name_;
    std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
    std::uint64_t given_ = 0;
    cv::Size size_;
    SteadyClock clock_;
};

} // namespace

bool isMjpegAddress(const std::string& address) { return address.starts_with(kHttp); }

std::unique_ptr<CaptureCamera> openMjpegCamera(const std::string& address) {
    return std::make_unique<MjpegCamera>(address);
}

} // namespace lumorph
