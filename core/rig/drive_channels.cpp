#include "core/rig/drive_channels.h"

#include <algorithm>
#include <set>

namespace lumorph {

std::vector<int> boardChannels(const Rig& rig, int first) {
    int least = first;
    for (const Actuator& actuator : rig.actuators())
        if (actuator.drive.channel >= 0) least = std::min(least, actuator.drive.channel);
    std::vector<int> channels;
    std::set<int> taken;
    for (const Actuator& actuator : rig.actuators()) {
        const int told = actuator.drive.channel;
        channels.push_back(told < 0 ? -1 : told + first - least);
        taken.insert(channels.back());
    }
    for (int& channel : channels) {
        if (channel >= 0) continue;
        while (taken.contains(first)) ++first;
        channel = first++;
    }
    return channels;
}

} // namespace lumorph
