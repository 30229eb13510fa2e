#include "devices/transport/link_world.h"

#include <utility>
#include <variant>

#include "devices/simulator/simulated_bench.h"
#include "devices/transport/link_keeper.h"
#include "devices/transport/simulated_transport.h"

namespace lumorph {

namespace {

std::string sightOf(const DeviceAddress& address, const SimulatedBench* bench) {
    const auto* simulated = std::get_if<SimulatedAddress>(&address);
    if (!simulated) return sightOfNode(address);
    const std::shared_ptr<SimulatedBoard> board = bench ? bench->board(simulated->device) : nullptr;
    if (!board) return {};
    const std::optional<LinkTrouble> trouble = simulatedTrouble(simulated->device, board->faults());
    return trouble ? trouble->why : "there";
}

} // namespace

LinkWorld realLinkWorld(SimulatedBench* bench) {
    return {[bench](const DeviceAddress& address, Transport::Events events) {
                return makeTransport(address, std::move(events), bench);
            },
            [] { return serialPorts(); }, [bench](const DeviceAddress& address) { return sightOf(address, bench); }};
}

LinkKeeper::LinkKeeper(DeviceAddress address, Events events, SimulatedBench* bench)
    : LinkKeeper(std::move(address), std::move(events), realLinkWorld(bench)) {}

} // namespace lumorph
