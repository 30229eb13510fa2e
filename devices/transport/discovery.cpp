#include "devices/transport/discovery.h"

#include "devices/simulator/simulated_bench.h"
#include "devices/transport/found_devices.h"
#include "devices/transport/simulated_transport.h"

namespace lumorph {

namespace {

FoundDevice describeBoard(const SimulatedBoard& board) {
    return {"sim://" + board.name(), board.product() + " (simulated)", "has no hardware", "simulated " + board.name(),
            simulatedTrouble(board.name(), board.faults()).value_or(LinkTrouble{})};
}

} // namespace

std::vector<FoundDevice> findDevices(const SimulatedBench* bench) {
    std::vector<FoundDevice> found = findRealDevices();
    if (!bench) return found;
    for (const std::string& name : bench->names())
        if (const std::shared_ptr<SimulatedBoard> board = bench->board(name)) found.push_back(describeBoard(*board));
    return found;
}

} // namespace lumorph
