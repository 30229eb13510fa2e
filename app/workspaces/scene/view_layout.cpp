#include "app/workspaces/scene/view_layout.h"

namespace lumorph::studio {
namespace {

constexpr int kPaneGap = 2;
constexpr double kLarger = 0.6; ///< of the lab beside the eye
/// Pictures of the device are wider than high: two are side by side only where there is room for both.
constexpr double kWide = 1.4;

/// Cuts a box in two, side by side or above each other.
std::pair<QRect, QRect> cut(const QRect& box, bool sideways, double share) {
    const int length = (sideways ? box.width() : box.height()) - kPaneGap;
    const int first = static_cast<int>(share * length);
    if (sideways)
        return {QRect(box.topLeft(), QSize(first, box.height())),
                QRect(box.left() + first + kPaneGap, box.top(), length - first, box.height())};
    return {QRect(box.topLeft(), QSize(box.width(), first)),
            QRect(box.left(), box.top() + first + kPaneGap, box.width(), length - first)};
}

} // namespace

std::vector<StagePlace> viewLayout(StageMode mode, const QSize& size) {
    const QRect whole(QPoint(0, 0), size);
    const bool wide = size.width() >= kWide * size.height();
    switch (mode) {
    case StageMode::eye:
        return {{ScenePane::eye, whole}};
    case StageMode::projector:
        return {{ScenePane::projector, whole}};
    case StageMode::device:
        return {{ScenePane::device, whole}};
    case StageMode::pair: {
        const auto [first, second] = cut(whole, wide, kLarger);
        return {{ScenePane::lab, first}, {ScenePane::eye, second}};
    }
    case StageMode::compare: {
        const auto [first, second] = cut(whole, wide, 0.5);
        return {{ScenePane::cropped, first}, {ScenePane::uncropped, second}};
    }
    case StageMode::all:
        break;
    }
    const auto [upper, lower] = cut(whole, false, 0.5);
    const auto [lab, eye] = cut(upper, true, 0.5);
    const auto [projector, device] = cut(lower, true, 0.5);
    return {
        {ScenePane::lab, lab}, {ScenePane::eye, eye}, {ScenePane::projector, projector}, {ScenePane::device, device}};
}

} // namespace lumorph::studio
