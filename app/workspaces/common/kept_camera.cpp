#include "app/workspaces/common/kept_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lumorph::studio {
namespace {

constexpr int kKeepMilliseconds = 500;
constexpr int kNumbers = 8;

QVariantList numbersOf(const ViewCamera& camera) {
    return {camera.pivot.x,
            camera.pivot.y,
            camera.pivot.z,
            camera.yaw.inDegrees(),
            camera.pitch.inDegrees(),
            camera.distance,
            camera.orthographic ? 1.0 : 0.0,
            camera.fieldOfView.inDegrees()};
}

/// Empty where the file was edited by hand, or by a version that kept other numbers.
std::optional<ViewCamera> cameraOf(const QVariantList& kept) {
    if (kept.size() != kNumbers) return std::nullopt;
    std::array<double, kNumbers> numbers{};
    for (int i = 0; i < kNumbers; ++i) {
        bool isNumber = false;
        numbers[static_cast<std::size_t>(i)] = kept[i].toDouble(&isNumber);
        if (!isNumber || !std::isfinite(numbers[static_cast<std::size_t>(i)])) return std::nullopt;
    }
    ViewCamera camera;
    camera.pivot = glm::vec3(numbers[0], numbers[1], numbers[2]);
    camera.yaw = Angle::degrees(numbers[3]);
    camera.pitch = Angle::degrees(std::clamp(numbers[4], -90.0, 90.0));
    camera.distance = std::clamp(numbers[5], 1e-3, 100.0);
    camera.orthographic = numbers[6] != 0.0;
    camera.fieldOfView = Angle::degrees(std::clamp(numbers[7], 1.0, 120.0));
    return camera;
}

} // namespace

KeptCamera::KeptCamera(Settings& settings, const QString& name, ViewportWidget* view)
    : QObject(view), settings_(settings), key_("camera/" + name) {
    due_.setSingleShot(true);
    due_.setInterval(kKeepMilliseconds);
    connect(&due_, &QTimer::timeout, this, &KeptCamera::keep);
    connect(view, &ViewportWidget::cameraChanged, this, [this, view] {
        if (!begun_) return;
        newest_ = view->camera();
        if (!due_.isActive()) due_.start();
    });
}

KeptCamera::~KeptCamera() {
    if (due_.isActive()) keep();
}

std::optional<ViewCamera> KeptCamera::begin(const QString& device) {
    const bool first = !std::exchange(begun_, true);
    device_ = device;
    const QVariantList kept = settings_.value(key_).toList();
    if (!first || kept.size() != kNumbers + 1 || kept.front().toString() != device) return std::nullopt;
    return cameraOf(kept.mid(1));
}

void KeptCamera::keep() { settings_.setValue(key_, QVariantList{device_} + numbersOf(newest_)); }

} // namespace lumorph::studio
