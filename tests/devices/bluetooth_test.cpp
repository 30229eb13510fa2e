#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "devices/transport/bluetooth_search.h"
#include "devices/transport/bluetooth_transport.h"
#include "devices/transport/bluetooth_trouble.h"
#include "tests/devices/event_loop.h"

namespace lumorph {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

TEST(Bluetooth, SaysInPlainWordsWhatIsInTheWay) {
    const std::string mac = "98:D3:31:F4:12:AB";
    struct Row {
        BluetoothObstacle obstacle;
        const char* why;
        const char* remedy;
    };
    const Row rows[] = {
        {BluetoothObstacle::noAdapter, "no Bluetooth adapter", "plug in"},
        {BluetoothObstacle::switchedOff, "switched off", "switch it on"},
        {BluetoothObstacle::notAllowed, "may not use Bluetooth", "usermod -aG bluetooth"},
        {BluetoothObstacle::notPaired, "98:D3:31:F4:12:AB is not paired", "1234 or 0000"},
        {BluetoothObstacle::outOfRange, "98:D3:31:F4:12:AB does not answer", "nearer"},
        {BluetoothObstacle::noSerialPort, "98:D3:31:F4:12:AB does not answer as a serial port", "HC-06"},
        {BluetoothObstacle::brokenOff, "link to 98:D3:31:F4:12:AB broke off", "power"},
    };
    for (const Row& row : rows) {
        const LinkTrouble trouble = bluetoothTrouble(row.obstacle, mac);
        EXPECT_THAT(trouble.why, HasSubstr(row.why));
        EXPECT_THAT(trouble.remedy, HasSubstr(row.remedy));
    }
}

TEST(Bluetooth, WithoutAnAdapterALinkFailsCleanly) {
    if (hasBluetoothAdapter()) GTEST_SKIP() << "this computer has a Bluetooth adapter";
    const EventLoop loop;
    std::vector<LinkTrouble> troubles;
    int opened = 0;
    const auto transport =
        makeBluetoothTransport({"98:D3:31:F4:12:AB"}, {[&] { ++opened; }, [](auto) {},
                                                       [&](const LinkTrouble& why) { troubles.push_back(why); }});
    for (std::size_t attempt = 1; attempt <= 2; ++attempt) {
        transport->open();
        ASSERT_TRUE(EventLoop::runUntil([&] { return troubles.size() == attempt; }, 2s));
        EXPECT_EQ(troubles.back(), bluetoothTrouble(BluetoothObstacle::noAdapter, {}));
        EXPECT_FALSE(transport->isOpen());
    }
    const std::vector<std::uint8_t> bytes{1, 2};
    transport->write(bytes); // dropped
    EXPECT_EQ(transport->unsent(), 0u);
    transport->close();
    EventLoop::runFor(20ms);
    EXPECT_EQ(troubles.size(), 2u);
    EXPECT_EQ(opened, 0);
    EXPECT_EQ(transport->identity(), "98:D3:31:F4:12:AB");
}

TEST(Bluetooth, WithoutAnAdapterASearchEndsAndSaysWhy) {
    if (hasBluetoothAdapter()) GTEST_SKIP() << "this computer has a Bluetooth adapter";
    const EventLoop loop;
    std::vector<LinkTrouble> ends;
    int found = 0;
    {
        BluetoothSearch search(
            {[&](const FoundDevice&) { ++found; }, [&](const LinkTrouble& why) { ends.push_back(why); }});
        search.start();
        EXPECT_TRUE(ends.empty()); // events come by the event loop alone
        EXPECT_TRUE(search.running());
        ASSERT_TRUE(EventLoop::runUntil([&] { return !ends.empty(); }, 2s));
        EXPECT_FALSE(search.running());
    }
    EXPECT_EQ(ends.size(), 1u);
    EXPECT_THAT(ends[0].why, HasSubstr("no Bluetooth adapter"));
    {
        BluetoothSearch gone(
            {[&](const FoundDevice&) { ++found; }, [&](const LinkTrouble& why) { ends.push_back(why); }});
        gone.start();
    }
    EventLoop::runFor(20ms);
    EXPECT_EQ(ends.size(), 1u);
    EXPECT_EQ(found, 0);
}

// --- A search against a Bluetooth service that the test has in hand

constexpr std::chrono::seconds kHang{10}; // as long as a service hangs that the test does not let go
constexpr std::chrono::seconds kSoon{5};  // on a machine that has much else to do
const FoundDevice kModule{"bt://98:D3:31:F4:12:AB", "HC-06 (Bluetooth)", {}, "98:D3:31:F4:12:AB", {}};

/// Counts scans and remembers in which threads they were made and destroyed. Asked, it hangs until it is let go.
class FakeService {
public:
    std::atomic<int> begun = 0, ended = 0;
    std::atomic<bool> hangs = false; ///< whoever waited for it is not let go yet
    std::promise<void> letGo;

    [[nodiscard]] std::vector<std::thread::id> threads() const {
        const std::scoped_lock lock(mutex_);
        return threads_;
    }
    void hang() {
        hangs = true;
        (void)going_.wait_for(kHang);
        hangs = false;
    }
    void note() {
        const std::scoped_lock lock(mutex_);
        threads_.push_back(std::this_thread::get_id());
    }

private:
    std::shared_future<void> going_ = letGo.get_future().share();
    mutable std::mutex mutex_;
    std::vector<std::thread::id> threads_;
};

class FakeScan final : public BluetoothScan {
public:
    explicit FakeScan(std::shared_ptr<FakeService> service) : service_(std::move(service)) { service_->note(); }
    ~FakeScan() override {
        service_->note();
        ++service_->ended;
    }
    FakeScan(const FakeScan&) = delete;
    FakeScan& operator=(const FakeScan&) = delete;

private:
    std::shared_ptr<FakeService> service_;
};

class BluetoothSearchTest : public testing::Test {
protected:
    [[nodiscard]] BluetoothSearch::Events events() {
        return {[this](const FoundDevice& device) { found_.push_back(device); },
                [this](const LinkTrouble& why) { ends_.push_back(why); }};
    }
    /// Finds one module, once the service answers.
    [[nodiscard]] BluetoothSearch::Begin begin() const {
        return [service = service_](const BluetoothSearch::Events& told) {
            ++service->begun;
            service->hang();
            auto scan = std::make_unique<FakeScan>(service);
            told.found(kModule);
            told.ended({});
            return scan;
        };
    }
    [[nodiscard]] bool hangs() const {
        return EventLoop::runUntil([&] { return service_->begun == 1; }, kSoon);
    }

    EventLoop loop_;
    std::shared_ptr<FakeService> service_ = std::make_shared<FakeService>();
    std::vector<FoundDevice> found_;
    std::vector<LinkTrouble> ends_;
};

TEST_F(BluetoothSearchTest, AServiceThatHangsHoldsUpNobodyWhoAsks) {
    BluetoothSearch search(events(), begin());
    search.start();
    ASSERT_TRUE(hangs());
    search.start(); // and again, by an impatient hand
    EventLoop::runFor(20ms);
    EXPECT_TRUE(service_->hangs) << "this thread did not wait for its end";
    EXPECT_TRUE(search.running());
    EXPECT_TRUE(found_.empty());
    service_->letGo.set_value();
    ASSERT_TRUE(EventLoop::runUntil([&] { return !search.running(); }, kSoon));
    EXPECT_THAT(found_, testing::ElementsAre(kModule));
    EXPECT_THAT(ends_, testing::ElementsAre(LinkTrouble{}));
    EXPECT_EQ(service_->begun, 1);
}

TEST_F(BluetoothSearchTest, ASearchThatHangsIsLeftBehindAndTakesAllWithIt) {
    auto search = std::make_unique<BluetoothSearch>(events(), begin());
    search->start();
    ASSERT_TRUE(hangs());
    search.reset();
    EXPECT_TRUE(service_->hangs) << "nobody waited for its end";
    EXPECT_EQ(service_->ended, 0);
    service_->letGo.set_value();
    EXPECT_TRUE(EventLoop::runUntil([&] { return service_.use_count() == 1; }, kSoon)) << "something is kept";
    EXPECT_EQ(service_->ended, 1);
    EXPECT_TRUE(found_.empty());
    EXPECT_TRUE(ends_.empty());
}

TEST_F(BluetoothSearchTest, ScansLiveAndDieInOneThreadThatIsNotTheAskers) {
    service_->letGo.set_value();
    BluetoothSearch search(events(), begin());
    for (int round = 1; round <= 3; ++round) {
        search.start();
        ASSERT_TRUE(EventLoop::runUntil([&] { return !search.running() && service_->ended == round; }, kSoon));
    }
    const std::vector<std::thread::id> threads = service_->threads();
    ASSERT_EQ(threads.size(), 6u);
    EXPECT_NE(threads[0], std::this_thread::get_id());
    EXPECT_THAT(threads, testing::Each(threads[0]));
    EXPECT_EQ(found_.size(), 3u);
}

TEST_F(BluetoothSearchTest, AScanThatFailsIsAnEndWithItsReason) {
    BluetoothSearch search(events(), [](const BluetoothSearch::Events&) -> std::unique_ptr<BluetoothScan> {
        throw std::runtime_error("out of sockets");
    });
    search.start();
    ASSERT_TRUE(EventLoop::runUntil([&] { return !ends_.empty(); }, kSoon));
    EXPECT_THAT(ends_[0].why, HasSubstr("out of sockets"));
    EXPECT_FALSE(search.running());
}

} // namespace
} // namespace lumorph
