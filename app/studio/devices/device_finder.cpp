#include "app/studio/devices/device_finder.h"

#include <thread>
#include <utility>

#include <QTimer>

#include "devices/simulator/simulated_bench.h"

namespace lumorph::studio {
namespace {

constexpr int kLookMilliseconds = 2000;

} // namespace

struct DeviceFinder::Data {
    explicit Data(DeviceFinder& owner, const SimulatedBench& boards) : finder(owner), bench(boards) {}

    void look();
    void take(std::vector<FoundDevice> now);
    void end(const LinkTrouble& trouble);

    DeviceFinder& finder;
    const SimulatedBench& bench;
    std::vector<FoundDevice> found;
    std::vector<FoundDevice> ofBluetooth;
    std::unique_ptr<BluetoothSearch> search;
    QTimer timer;
    bool looking = false;
    std::jthread looker; ///< last: it uses the above
};

/// Looking at the system's ports may take its time on some machines.
void DeviceFinder::Data::look() {
    if (std::exchange(looking, true)) return;
    looker = std::jthread([this] {
        std::vector<FoundDevice> now;
        try {
            now = findDevices(&bench);
        } catch (const std::exception&) {
            now.clear(); // a port that vanished meanwhile; the next look comes soon
        }
        QMetaObject::invokeMethod(
            &finder, [this, now]() mutable { take(std::move(now)); }, Qt::QueuedConnection);
    });
}

void DeviceFinder::Data::take(std::vector<FoundDevice> now) {
    looking = false;
    now.insert(now.end(), ofBluetooth.begin(), ofBluetooth.end());
    if (now == found) return;
    found = std::move(now);
    emit finder.changed();
}

void DeviceFinder::Data::end(const LinkTrouble& trouble) {
    search.reset();
    if (!trouble.why.empty()) emit finder.searchFailed(trouble);
    emit finder.changed();
}

DeviceFinder::DeviceFinder(const SimulatedBench& bench) : data_(std::make_unique<Data>(*this, bench)) {
    data_->timer.setInterval(kLookMilliseconds);
    connect(&data_->timer, &QTimer::timeout, this, [this] { data_->look(); });
}

DeviceFinder::~DeviceFinder() = default;

const std::vector<FoundDevice>& DeviceFinder::found() const noexcept { return data_->found; }
bool DeviceFinder::searchingBluetooth() const noexcept { return data_->search != nullptr; }

void DeviceFinder::setLooking(bool looking) {
    if (!looking) return data_->timer.stop();
    data_->timer.start();
    data_->look();
}

void DeviceFinder::searchBluetooth() {
    if (data_->search) return;
    data_->ofBluetooth.clear();
    BluetoothSearch::Events events;
    events.found = [this](const FoundDevice& one) {
        data_->ofBluetooth.push_back(one);
        data_->found.push_back(one);
        emit changed();
    };
    events.ended = [this](const LinkTrouble& trouble) {
        // The search must not be destroyed inside its own call.
        QMetaObject::invokeMethod(
            this, [this, trouble] { data_->end(trouble); }, Qt::QueuedConnection);
    };
    data_->search = std::make_unique<BluetoothSearch>(std::move(events));
    emit changed();
}

} // namespace lumorph::studio
