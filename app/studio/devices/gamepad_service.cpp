#include "app/studio/devices/gamepad_service.h"

namespace lumorph::studio {

GamepadService::GamepadService(StudioLoop& loop) : loop_(loop) {
    connect(&loop_, &StudioLoop::driverChanged, this, &GamepadService::follow);
}

void GamepadService::open() {
    pads_ = std::make_unique<Gamepads>([this](const ShowInput& input) {
        QMetaObject::invokeMethod(
            this, [this, input] { loop_.input(input.name, input.value); }, Qt::QueuedConnection);
    });
    follow();
}

void GamepadService::follow() {
    if (pads_) pads_->setPolling(loop_.program() != nullptr);
}

} // namespace lumorph::studio
