#include "devices/controllers/controller_base.h"

namespace lumorph {

std::unique_ptr<ServoController> makeController(const DeviceProfile& profile, const DeviceAddress& address) {
    switch (profile.controller) {
    case ControllerKind::lewansoul:
        return makeLewansoul(profile, address);
    case ControllerKind::maestro:
        return makeMaestro(profile, address);
    case ControllerKind::firmata:
        break;
    }
    return makeFirmata(profile, address);
}

} // namespace lumorph
