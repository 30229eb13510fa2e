#include "devices/trackers/tracker_advice.h"

#include <cstdio>

namespace lumorph {

namespace {

constexpr Microseconds kFrameSilence{1'000'000};
constexpr Microseconds kRecent{5'000'000};

constexpr const char* kHowToOpen =
    "close it, switch on 'Take packets from other machines' and open it again (on the command line: --open)";

bool isRecent(const std::optional<Microseconds>& since) { return since && *since < kRecent; }

bool allIsWell(const TrackerSituation& s) {
    if (s.sinceFrame) return *s.sinceFrame <= kFrameSilence;
    return s.sinceOpened <= kFrameSilence;
}

std::string seconds(Microseconds time) { return std::to_string(time.count() / 1'000'000) + " s"; }

/// "Nothing has arrived for 12 s" or "Nothing arrives"; from whom or where follows.
std::string silence(const TrackerSituation& s) {
    return s.sinceFrame ? "No pose has arrived for " + seconds(*s.sinceFrame) : "No pose arrives";
}

std::string droppedWord(const TrackerSituation& s) {
    return std::to_string(s.dropped) + (s.dropped == 1 ? " packet" : " packets") +
           " of another machine (the last from " + s.lastDropped + ") " + (s.dropped == 1 ? "was" : "were") +
           " dropped: this input takes only what this machine sends. Open it to the network if that is your tracker. ";
}

/// What is the same for all: packets that came and could not be used.
std::string commonAdvice(const TrackerSituation& s) {
    if (!s.trouble.empty()) return s.trouble;
    if (isRecent(s.sinceRejected)) return "What arrives cannot be used: " + s.lastRejected + ". ";
    if (isRecent(s.sinceDropped)) return droppedWord(s);
    return {};
}

std::string trimmed(std::string text) {
    while (text.ends_with(' ')) text.pop_back();
    return text;
}

std::string machineList(const TrackerSituation& s) { return "this machine has " + s.ownAddresses; }

/// While it is closed, a group is heard on loopback alone, also where the server is named by another address of ours.
bool isLoopbackAlone(const NatNetAddress& address, const TrackerSituation& s) {
    return address.multicast && !s.openToNetwork;
}

/// The interface on which a server on this machine has to send.
std::string interfaceHere(const NatNetAddress& address, const TrackerSituation& s) {
    return isLoopbackAlone(address, s) ? "127.0.0.1" : address.host;
}

std::string otherInterfaceWord(const NatNetAddress& address, const TrackerSituation& s) {
    if (!isLoopbackAlone(address, s)) return {};
    return std::string(" If it has to send on another interface, open this input to the network: ") + kHowToOpen + ".";
}

std::string groupOf(const natnet::Connection& c) {
    char text[32];
    std::snprintf(text, sizeof text, "%d.%d.%d.%d", c.address[0], c.address[1], c.address[2], c.address[3]);
    return text;
}

/// The server answers, but its frames do not come here.
std::string serverWithoutFrames(const NatNetAddress& address, const NatNetSituation& s) {
    const std::string name = s.server->name.empty() ? "The server" : s.server->name;
    const auto& connection = s.server->connection;
    if (connection && connection->multicast != address.multicast)
        return name + " at " + address.host + " sends by " + (connection->multicast ? "multicast" : "unicast") +
               ", but the address says mode=" + (address.multicast ? "multicast" : "unicast") +
               ". Change one of the two.";
    if (connection && address.multicast && connection->dataPort != address.data)
        return name + " sends to port " + std::to_string(connection->dataPort) +
               ", but the address listens to data=" + std::to_string(address.data) + ". Change one of the two.";
    if (connection && address.multicast && groupOf(*connection) != address.group)
        return name + " sends to the group " + groupOf(*connection) +
               ", but the address says multicast=" + address.group + ". Change one of the two.";
    const std::string lead = name + " at " + address.host +
                             " answers, but sends no frames. Check in this order: that streaming is switched on there "
                             "('Broadcast Frame Data'); that it is live or playing, not paused; ";
    if (s.hostIsHere)
        return lead + "that it sends on the interface " + interfaceHere(address, s) + "." +
               otherInterfaceWord(address, s);
    return lead + "that no firewall " + "blocks UDP port " + std::to_string(address.data) + " here; " +
           (address.multicast ? "that local= names our address on the network of the server, " + machineList(s) + "."
                              : "that it is set to unicast.");
}

/// A server on this machine needs no network and meets no firewall.
std::string silentHere(const NatNetAddress& address, const NatNetSituation& s) {
    return silence(s) + " from " + address.host +
           ", which is this machine. Check in this order: that Motive, or what " +
           "stands for it, runs here; that streaming is switched on there ('Broadcast Frame Data'), by " +
           (address.multicast ? "multicast" : "unicast") + " and on the interface " + interfaceHere(address, s) +
           "; that it listens to commands on UDP port " + std::to_string(address.command) +
           (address.multicast ? " and sends to port " + std::to_string(address.data) : std::string()) + "." +
           otherInterfaceWord(address, s);
}

std::string unreachableServer(const NatNetAddress& address, const NatNetSituation& s) {
    if (s.hostIsHere) return silentHere(address, s);
    return silence(s) + " from " + address.host + ". Check in this order: that " + address.host +
           " is the address of the machine on which Motive runs; that streaming is switched on there ('Broadcast "
           "Frame Data'), by " +
           (address.multicast ? "multicast" : "unicast") + " and on a network interface that leads here, not on " +
           "loopback; that no firewall blocks UDP ports " + std::to_string(address.command) + " and " +
           std::to_string(address.data) +
           ", there and here; that this machine is on the same network: " + machineList(s) + ".";
}

std::string listenerAdvice(std::uint16_t port, const TrackerSituation& s, const std::string& program) {
    if (allIsWell(s)) return {};
    std::string advice = commonAdvice(s);
    if (!advice.empty()) return trimmed(advice);
    advice = silence(s) + " at port " + std::to_string(port) + ". Check in this order: that " + program +
             "; that it sends to port " + std::to_string(port);
    if (s.openToNetwork)
        return advice + " of this machine, which has " + s.ownAddresses + "; that no firewall blocks UDP port " +
               std::to_string(port) + " here.";
    return advice + " of 127.0.0.1. If it runs on another machine, open this input to the network: " + kHowToOpen + ".";
}

} // namespace

std::string adviceFor(const NatNetAddress& address, const NatNetSituation& s) {
    if (s.localMissing)
        return "This machine has no address " + address.local + ", which the tracker's address names with local=; " +
               machineList(s) + ". Use one of these, or connect the network.";
    if (!s.hostIsHere && !s.openToNetwork)
        return address.host + " is another machine, and this input takes only what this machine sends. Open it to " +
               "the network: " + kHowToOpen + "." + (s.dropped > 0 ? " " + trimmed(droppedWord(s)) : "");
    if (allIsWell(s)) return {};
    if (s.framesWithoutVersion)
        return "Frames arrive, but the server does not answer at port " + std::to_string(address.command) + " of " +
               address.host + ", so that their version is not known. Check that port and the firewall, or write " +
               "the version into the address, such as version=3.0.";
    const std::string common = commonAdvice(s);
    if (!common.empty()) return trimmed(common);
    if (s.server && !s.sinceFrame) return serverWithoutFrames(address, s);
    return unreachableServer(address, s);
}

std::string adviceFor(const OpenTrackAddress& address, const TrackerSituation& situation) {
    return listenerAdvice(address.port, situation, "opentrack runs and is started, with the output 'UDP over network'");
}

std::string adviceFor(const OscAddress& address, const TrackerSituation& situation, bool onlyRotations) {
    // Positions go on where rotations are refused: then a head stands right and looks wrong.
    if (allIsWell(situation) && isRecent(situation.sinceRejected))
        return "Poses arrive, but some of what arrives cannot be used: " + situation.lastRejected + ".";
    if (!allIsWell(situation) && onlyRotations)
        return "Only rotations arrive. Let the sender send /tracking/trackers/head/position as well.";
    return listenerAdvice(address.port, situation,
                          "the phone or bridge runs and sends /tracking/trackers/head/position");
}

std::string adviceFor(const SharedName& shared) {
    const bool isOne = shared.more == 0;
    std::string bodies = "'" + shared.body + "'";
    if (!isOne) bodies += " and " + std::to_string(shared.more) + (shared.more == 1 ? " other body" : " other bodies");
    const std::string other = shared.address + (shared.source.empty() ? "" : " (" + shared.source + ")");
    return bodies + " of this tracker " + (isOne ? "is" : "are") + " not followed: " + other + " brings the same " +
           (isOne ? "name" : "names") + " and came first. Close one of the two trackers, or rename the " +
           (isOne ? "body" : "bodies") + " in its program.";
}

} // namespace lumorph
