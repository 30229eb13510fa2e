#include "core/rig/pulse_curve.h"

#include <algorithm>

namespace lumorph {

bool isPulseCurve(std::span<const double> curve) noexcept {
    const auto notRising = [](double a, double b) { return !(a < b); };
    return curve.empty() || (curve.size() >= 2 && curve.size() <= kMostCurvePoints && curve.front() == 0.0 &&
                             curve.back() == 1.0 && std::ranges::adjacent_find(curve, notRising) == curve.end());
}

double turnedAt(std::span<const double> curve, double stroke) noexcept {
    if (curve.empty()) return stroke;
    const std::size_t steps = curve.size() - 1;
    const double at = stroke * static_cast<double>(steps);
    const auto step = static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(steps - 1)));
    return curve[step] + (at - static_cast<double>(step)) * (curve[step + 1] - curve[step]);
}

double strokeWhereTurned(std::span<const double> curve, double share) noexcept {
    if (curve.empty()) return share;
    const std::size_t steps = curve.size() - 1;
    const auto above = std::ranges::upper_bound(curve, share) - curve.begin();
    const auto step = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, std::ssize(curve) - 2));
    return (static_cast<double>(step) + (share - curve[step]) / (curve[step + 1] - curve[step])) /
           static_cast<double>(steps);
}

double steepest(std::span<const double> curve) noexcept {
    double most = curve.empty() ? 1.0 : 0.0;
    for (std::size_t k = 0; k + 1 < curve.size(); ++k)
        most = std::max(most, (curve[k + 1] - curve[k]) * static_cast<double>(curve.size() - 1));
    return most;
}

PulseCurve upTo(std::span<const double> curve, double stroke) {
    PulseCurve part(curve.begin(), curve.end());
    const double all = turnedAt(curve, stroke);
    for (std::size_t k = 0; k < part.size(); ++k)
        part[k] = turnedAt(curve, stroke * static_cast<double>(k) / static_cast<double>(part.size() - 1)) / all;
    if (!part.empty()) part.back() = 1.0;
    return part;
}

} // namespace lumorph
