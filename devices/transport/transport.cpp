#include "devices/transport/transport.h"

#include <utility>
#include <variant>

#include "core/base/error.h"
#include "devices/simulator/simulated_bench.h"
#include "devices/transport/bluetooth_transport.h"
#include "devices/transport/hid_transport.h"
#include "devices/transport/serial_transport.h"
#include "devices/transport/simulated_transport.h"

namespace lumorph {

namespace {

/// Stands for a simulated board where nothing is simulated.
class NoTransport final : public Transport {
public:
    explicit NoTransport(Events events) : events_(std::move(events)) {}
    void open() override {
        events_.closed({"there are no simulated devices here", "choose a real device, or start the simulator"});
    }
    void close() override {}
    [[nodiscard]] bool isOpen() const override { return false; }
    void write(std::span<const std::uint8_t>) override {}
    [[nodiscard]] std::size_t unsent() const override { return 0; }
    [[nodiscard]] std::string identity() const override { return {}; }
    [[nodiscard]] std::string product() const override { return {}; }

private:
    Events events_;
};

struct Maker {
    Transport::Events& events;
    SimulatedBench* bench;

    std::unique_ptr<Transport> operator()(const SerialAddress& address) const {
        return makeSerialTransport(address, std::move(events));
    }
    std::unique_ptr<Transport> operator()(const BluetoothAddress& address) const {
        return makeBluetoothTransport(address, std::move(events));
    }
    std::unique_ptr<Transport> operator()(const HidAddress& address) const {
        return makeHidTransport(address, std::move(events));
    }
    std::unique_ptr<Transport> operator()(const SimulatedAddress& address) const {
        if (!bench) return std::make_unique<NoTransport>(std::move(events));
        std::shared_ptr<SimulatedBoard> board = bench->board(address.device);
        if (board)
            return makeSimulatedTransport(std::move(board), address, std::move(events),
                                          [source = bench] { return source->now(); });
        std::string names;
        for (const std::string& name : bench->names()) names += (names.empty() ? "" : ", ") + name;
        throw InvalidInput("simulated device '" + address.device + "'", "there is none of this name",
                           "choose one of " + names);
    }
};

} // namespace

std::unique_ptr<Transport> makeTransport(const DeviceAddress& address, Transport::Events events,
                                         SimulatedBench* bench) {
    return std::visit(Maker{events, bench}, address);
}

} // namespace lumorph
