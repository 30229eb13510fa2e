#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "calibration/lab/lab_light.h"
#include "core/scene/installation.h"
#include "core/scene/projector_response.h"

namespace lumorph::test {

/// How far measured light is from the true one.
struct LightErrors {
    double curve = 0.0;   ///< of white, at any value
    double gain = 0.0;    ///< share, apart from how bright all is
    double black = 0.0;   ///< of white
    double colors = 0.0;  ///< sRGB
    double product = 0.0; ///< share: gain times device or table, apart from how bright all is
};

inline LightErrors lightErrorsOf(const Installation& measured, const Installation& truth) {
    LightErrors errors;
    double logs = 0.0, count = 0.0;
    const auto each = [&](const auto& use) {
        for (std::size_t p = 0; p < truth.projectors.size(); ++p)
            for (int channel = 0; channel < 3; ++channel) use(measured.projectors[p], truth.projectors[p], channel);
    };
    using Projector = InstalledProjector;
    each([&](const Projector& found, const Projector& real, int c) {
        logs += std::log(static_cast<double>(found.gain[c] / real.gain[c]));
        count += 1.0;
        errors.black = std::max(errors.black, std::abs(static_cast<double>(found.black[c] - real.black[c])));
        for (int k = 0; k <= 255; ++k)
            errors.curve =
                std::max(errors.curve, std::abs(lightOfValue(found, k / 255.0)[c] - lightOfValue(real, k / 255.0)[c]));
    });
    each([&](const Projector& found, const Projector& real, int c) {
        const double ratio = static_cast<double>(found.gain[c] / real.gain[c]) / std::exp(logs / count);
        errors.gain = std::max(errors.gain, std::abs(ratio - 1.0));
    });
    std::vector<double> products;
    for (const bool device : {true, false}) {
        const glm::vec3 found = device ? measured.deviceColor : measured.tableColor;
        const glm::vec3 real = device ? truth.deviceColor : truth.tableColor;
        for (int c = 0; c < 3; ++c)
            errors.colors = std::max(errors.colors, std::abs(static_cast<double>(found[c] - real[c])));
        const glm::vec3 light = lightOfSrgb(found) / lightOfSrgb(real);
        each([&](const Projector& one, const Projector& other, int c) {
            products.push_back(static_cast<double>(light[c] * one.gain[c] / other.gain[c]));
        });
    }
    double mean = 0.0;
    for (const double product : products) mean += std::log(product) / static_cast<double>(products.size());
    for (const double product : products)
        errors.product = std::max(errors.product, std::abs(product / std::exp(mean) - 1.0));
    return errors;
}

} // namespace lumorph::test
