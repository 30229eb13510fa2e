#include "devices/transport/hid_transport.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <QObject>
#include <fcntl.h>
#include <hidapi/hidapi.h>
#include <unistd.h>

#include "core/base/error.h"
#include "devices/transport/hid_devices.h"

namespace lumorph {

namespace {

constexpr std::size_t kReport = 64;
constexpr std::chrono::milliseconds kHidLook{
    4};                          // how long a report may lie unread: 250 looks a second cost next to nothing
constexpr int kMostReports = 16; // read before the next write has its turn

using OutputReport = std::array<std::uint8_t, kReport + 1>; // begins with the report's number, 0

/// One open device and the thread that reads and writes it: hidapi allows but one at a time.
class HidWorker {
public:
    struct Events { // in the worker's thread
        std::function<void(std::vector<std::uint8_t>)> received;
        std::function<void()> died;
    };

    HidWorker(hid_device* device, Events events)
        : device_(device), events_(std::move(events)), thread_([this] { work(); }) {}
    ~HidWorker() { stop(); } // and waits for the thread

    /// Returns at once; the device is closed when what is being written is through.
    void stop() {
        const std::scoped_lock lock(mutex_);
        stopped_ = true;
        waiting_.clear();
        changed_.notify_one();
    }
    [[nodiscard]] bool hasEnded() const { return ended_; }

    void write(const OutputReport& report) {
        const std::scoped_lock lock(mutex_);
        waiting_.push_back(report);
        changed_.notify_one();
    }
    void dropUnsent() {
        const std::scoped_lock lock(mutex_);
        waiting_.clear();
    }
    [[nodiscard]] std::size_t unsent() const {
        const std::scoped_lock lock(mutex_);
        return kReport * (waiting_.size() + (writing_ ? 1 : 0));
    }

private:
    /// False when it is to end.
    bool nextToWrite(std::optional<OutputReport>& report) {
        std::unique_lock lock(mutex_);
        writing_ = false;
        changed_.wait_for(lock, kHidLook, [this] { return stopped_ || !waiting_.empty(); });
        if (stopped_) return false;
        report.reset();
        if (waiting_.empty()) return true;
        report = waiting_.front();
        waiting_.pop_front();
        writing_ = true;
        return true;
    }

    /// False where the device is gone.
    bool readWaiting() {
        std::array<std::uint8_t, kReport> report;
        for (int i = 0; i < kMostReports; ++i) {
            const int count = hid_read_timeout(device_, report.data(), report.size(), 0);
            if (count <= 0) return count == 0;
            const auto length = std::min(static_cast<std::size_t>(count), report.size());
            events_.received({report.begin(), report.begin() + static_cast<std::ptrdiff_t>(length)});
        }
        return true;
    }

    void work() {
        std::optional<OutputReport> report;
        while (nextToWrite(report)) {
            if (report && hid_write(device_, report->data(), report->size()) < 0) break;
            if (!readWaiting()) break;
        }
        hid_close(device_);
        events_.died();
        ended_ = true;
    }

    hid_device* device_;
    Events events_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<OutputReport> waiting_;
    bool writing_ = false;
    bool stopped_ = false;
    std::atomic<bool> ended_ = false;
    std::jthread thread_; ///< last: it uses all of the above
};

/// Claims a board for one link of this program, until the claim is dropped; null where another one has it. The system
/// lets a board be opened twice; but two guards that drive the same servos guard nothing, as when one link still takes
/// them to rest while the next begins.
std::shared_ptr<const std::string> claim(const std::string& path) {
    static std::mutex mutex;
    static std::set<std::string> claimed;
    const std::scoped_lock lock(mutex);
    if (!claimed.insert(path).second) return nullptr;
    return {new std::string(path), [](const std::string* its) {
                const std::unique_ptr<const std::string> freed(its);
                const std::scoped_lock again(mutex);
                claimed.erase(*freed);
            }};
}

class HidTransport final : public Transport {
public:
    HidTransport(HidAddress address, Events events) : address_(std::move(address)), events_(std::move(events)) {}
    ~HidTransport() override { close(); }
    HidTransport(const HidTransport&) = delete;
    HidTransport& operator=(const HidTransport&) = delete;

    void open() override;
    void close() override;
    [[nodiscard]] bool isOpen() const override { return worker_ != nullptr; }
    void write(std::span<const std::uint8_t> message) override;
    void dropUnsent() override {
        if (worker_) worker_->dropUnsent();
    }
    [[nodiscard]] std::size_t unsent() const override { return worker_ ? worker_->unsent() : 0; }
    [[nodiscard]] std::string identity() const override { return facts_.serialNumber; }
    [[nodiscard]] std::string product() const override { return facts_.productText; }
    [[nodiscard]] SharedLink shared() const override { return {node_, kReport}; }

private:
    std::optional<LinkTrouble> tryOpen();
    /// Runs `what` in the transport's thread, if the link of now is still open by then.
    void post(std::function<void()> what, std::uint64_t link);
    void die();

    HidAddress address_;
    Events events_;
    HidDevice facts_;
    int node_ = -1;                            ///< the device's node, opened once more: hidapi keeps its own to itself
    std::shared_ptr<const std::string> claim_; ///< while it is open
    std::uint64_t link_ = 0; ///< counts the links, so that words of an old one are not taken for the new one's
    QObject receiver_;
    std::unique_ptr<HidWorker> worker_;
    std::vector<std::unique_ptr<HidWorker>> ending_; ///< may still hang in a write
};

void HidTransport::open() {
    if (worker_) return;
    std::erase_if(ending_, [](const auto& worker) { return worker->hasEnded(); });
    if (const std::optional<LinkTrouble> trouble = tryOpen()) {
        events_.closed(*trouble);
        return;
    }
    events_.opened();
}

std::optional<LinkTrouble> HidTransport::tryOpen() {
    const auto choice = chooseHidDevice(address_, facts_.serialNumber, hidDevices(address_.vendor, address_.product));
    if (const auto* trouble = std::get_if<LinkTrouble>(&choice)) return *trouble;
    const HidDevice& found = std::get<HidDevice>(choice);
    auto claimed = claim(found.path);
    if (!claimed)
        return LinkTrouble{"the link before still takes the servos of " + found.productText + " to rest",
                           "wait a moment: it is opened by itself"};
    const auto opened = openHidDevice(found.path);
    if (const auto* trouble = std::get_if<LinkTrouble>(&opened)) return *trouble;
    facts_ = found;
    const std::uint64_t link = ++link_;
    const auto received = [this, link](const std::vector<std::uint8_t>& report) {
        post([this, report] { events_.received(report); }, link);
    };
    const auto died = [this, link] { post([this] { die(); }, link); };
    worker_ = std::make_unique<HidWorker>(std::get<hid_device_*>(opened), HidWorker::Events{received, died});
    claim_ = std::move(claimed);
    node_ = ::open(found.path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    return std::nullopt;
}

void HidTransport::post(std::function<void()> what, std::uint64_t link) {
    QMetaObject::invokeMethod(
        &receiver_,
        [this, what = std::move(what), link] {
            if (worker_ && link == link_) what();
        },
        Qt::QueuedConnection);
}

void HidTransport::close() {
    if (!worker_) return;
    worker_->stop();
    ending_.push_back(std::move(worker_));
    claim_.reset();
    if (const int node = std::exchange(node_, -1); node >= 0) ::close(node);
}

void HidTransport::die() {
    close();
    events_.closed({"the USB link to " + (facts_.productText.empty() ? facts_.path : facts_.productText) + " broke off",
                    "check the cable and the controller's power; it is connected again when it is back"});
}

void HidTransport::write(std::span<const std::uint8_t> message) {
    if (message.size() > kReport)
        throw InvalidInput("message of " + std::to_string(message.size()) + " bytes", "a USB report holds 64",
                           "send it in parts");
    if (!worker_) return;
    OutputReport report{};
    std::ranges::copy(message, report.begin() + 1);
    worker_->write(report);
}

} // namespace

std::unique_ptr<Transport> makeHidTransport(HidAddress address, Transport::Events events) {
    return std::make_unique<HidTransport>(std::move(address), std::move(events));
}

} // namespace lumorph
