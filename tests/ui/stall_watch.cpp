#include "tests/ui/stall_watch.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <QCoreApplication>
#include <QEvent>
#include <unistd.h>

namespace lumorph::test {

namespace {

using namespace std::chrono_literals;
using Steady = std::chrono::steady_clock;

/// Milliseconds that each processor lost to other virtual machines since it was started (proc_stat(5)).
std::vector<double> stolen() {
    constexpr int kStealColumn = 8;
    const double tick = 1000.0 / static_cast<double>(::sysconf(_SC_CLK_TCK));
    std::vector<double> processors;
    std::ifstream file("/proc/stat");
    for (std::string line; std::getline(file, line) && line.starts_with("cpu");) {
        if (line[3] == ' ') continue; // all together
        std::istringstream words(line);
        std::string name;
        double ticks = 0.0;
        words >> name;
        for (int column = 1; column <= kStealColumn; ++column) words >> ticks;
        processors.push_back(ticks * tick);
    }
    return processors;
}

/// The most that one processor lost between the two.
double mostStolen(const std::vector<double>& before, const std::vector<double>& after) {
    double most = 0.0;
    for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) most = std::max(most, after[i] - before[i]);
    return most;
}

} // namespace

struct StallWatch::Ping : QObject {
    explicit Ping(StallWatch& owner) : watch(owner) {}
    bool event(QEvent* event) override {
        if (event->type() != QEvent::User) return QObject::event(event);
        const double waited = std::chrono::duration<double, std::milli>(Steady::now() - sent).count();
        if (waited > watch.longest_)
            watch.longest_ = std::max(watch.longest_.load(), waited - mostStolen(lost, stolen()));
        watch.answered_ = true;
        return true;
    }
    StallWatch& watch;
    std::vector<double> lost;
    Steady::time_point sent;
};

StallWatch::StallWatch() : receiver_(std::make_unique<Ping>(*this)) {
    thread_ = std::jthread([this](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            if (answered_.exchange(false)) {
                auto& ping = static_cast<Ping&>(*receiver_);
                ping.lost = stolen();
                ping.sent = Steady::now();
                QCoreApplication::postEvent(&ping, new QEvent(QEvent::User));
            }
            std::this_thread::sleep_for(2ms);
        }
    });
}

StallWatch::~StallWatch() {
    thread_.request_stop();
    thread_.join();
}

double StallWatch::takeLongest() { return longest_.exchange(0.0); }

} // namespace lumorph::test
