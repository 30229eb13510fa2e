#include "app/studio/devices/device_finder.h"

#include <thread>
#include <utility>

#include <QTimer>

#include "devices/simulator/simulated_bench.h"
#include "devices/transport/bluetooth_search.h"

namespace lumorph::studio {
namespace {

constexpr int kLookMilliseconds = 2000;

} // namespace

struct DeviceFinder::Data {
    explicit Data(DeviceFinder& owner, const SimulatedBench& boards) : finder(owner), bench(boards) {}

    void look();
    void take(std::vector<FoundDevice> now);
    void add(const FoundDevice& one);
    void end(const LinkTrouble& trouble);

    DeviceFinder& finder;
    const SimulatedBench& bench;
    std::vector<FoundDevice> found;
    std::vector<FoundDevice> ofBluetooth;
    BluetoothSearch search{BluetoothSearch::Events{[this](const FoundDevice& one) { add(one); },
                                                   [this](const LinkTrouble& trouble) { end(trouble); }}};
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

void DeviceFinder::Data::add(const FoundDevice& one) {
    ofBluetooth.push_back(one);
    found.push_back(one);
    emit finder.changed();
}

void DeviceFinder::Data::end(const LinkTrouble& trouble) {
    if (!trouble.why.empty()) emit finder.searchFailed(trouble);
    emit finder.changed();
}

DeviceFinder::DeviceFinder(const SimulatedBench& bench) : data_(std::make_unique<Data>(*this, bench)) {
    data_->timer.setInterval(kLookMilliseconds);
    connect(&data_->timer, &QTimer::timeout, this, [this] { data_->look(); });
}

DeviceFinder::~DeviceFinder() = default;

const std::vector<FoundDevice>& DeviceFinder::found() const noexcept { return data_->found; }
bool DeviceFinder::searchingBluetooth() const noexcept { return data_->search.running(); }

void DeviceFinder::setLooking(bool looking) {
    if (!looking) return data_->timer.stop();
    data_->timer.start();
    data_->look();
}

void DeviceFinder::searchBluetooth() {
    if (data_->search.running()) return;
    data_->ofBluetooth.clear();
    data_->search.start();
    emit changed();
}

} // namespace lumorph::studio
