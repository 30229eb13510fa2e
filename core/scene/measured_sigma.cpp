#include "core/scene/measured_sigma.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>
#include <system_error>

namespace lumorph {
namespace {

constexpr std::string_view kPlusMinus = "\u00B1", kDegrees = "\u00B0";

struct Unit {
    std::string_view name;
    double inSi;
    double MeasuredSigma::*figure;
};
constexpr std::array kUnits{
    Unit{" mm", 1e-3, &MeasuredSigma::metres}, Unit{kDegrees, std::numbers::pi / 180.0, &MeasuredSigma::radians},
    Unit{" ms", 1e-3, &MeasuredSigma::seconds}, Unit{" mm of the tip", 1e-3, &MeasuredSigma::tipMetres}};

/// Of each unit: what devices without noise say has no figure that anybody would believe.
constexpr double kLeast = 1e-3;

/// Three digits that count, with a point whatever the locale.
std::string textOf(double value) {
    std::array<char, 64> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 3);
    return {text.data(), end.ptr};
}

} // namespace

std::string withSigma(std::string method, const MeasuredSigma& sigma) {
    for (const Unit& unit : kUnits) {
        const double value = sigma.*unit.figure / unit.inSi;
        if (!std::isfinite(value) || !(value > 0.0)) continue;
        if (!method.empty()) method += ", ";
        method += std::string(kPlusMinus) + textOf(std::max(value, kLeast)) + std::string(unit.name);
    }
    return method;
}

MeasuredSigma sigmaOf(const Origin& origin) {
    MeasuredSigma sigma;
    std::string_view rest = origin.method;
    for (std::size_t at = rest.find(kPlusMinus); at != std::string_view::npos; at = rest.find(kPlusMinus)) {
        rest.remove_prefix(at + kPlusMinus.size());
        double value = 0.0;
        const auto read = std::from_chars(rest.data(), rest.data() + rest.size(), value);
        if (read.ec != std::errc() || !std::isfinite(value) || !(value > 0.0)) continue;
        rest.remove_prefix(static_cast<std::size_t>(read.ptr - rest.data()));
        const Unit* longest = nullptr; // " mm" begins " mm of the tip"
        for (const Unit& unit : kUnits)
            if (rest.starts_with(unit.name) && (!longest || unit.name.size() > longest->name.size())) longest = &unit;
        if (longest) sigma.*longest->figure = value * longest->inSi;
    }
    return sigma;
}

} // namespace lumorph
