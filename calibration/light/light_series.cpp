#include "calibration/light/light_series.h"

#include <algorithm>
#include <cmath>

#include "calibration/decode/refusal.h"

namespace lumorph {

namespace {

constexpr double kBrightestWanted = 232.0; // byte of the brightest patch under full white
constexpr double kDimmestWanted = 60.0;    // what it must reach at the longest exposure
constexpr std::array<double, 3> kLonger = {1.0, 3.3, 11.0};

double brightestOf(const LightShot::Exposed& exposed) {
    double most = 0.0;
    for (const glm::dvec3& bytes : exposed.bytes) most = std::max({most, bytes.r, bytes.g, bytes.b});
    return most;
}

} // namespace

LightShot::Exposed LightSeries::expose(const LightShow& show, double seconds) {
    ++photographs_;
    const cv::Mat picture = bench_.photograph(show, seconds);
    isMonochrome_ = picture.channels() == 1;
    return {seconds, patchBytes(patches_, picture)};
}

void LightSeries::setExposure(const LightShow& white) {
    if (const auto found = bench_.foundExposure()) {
        seconds_ = found->seconds;
        photographs_ = found->photographs;
        return;
    }
    lookForExposure(white);
    bench_.exposureFound({seconds_, photographs_});
}

void LightSeries::lookForExposure(const LightShow& white) {
    seconds_ = bench_.shortestExposure();
    double brightest = brightestOf(expose(white, seconds_));
    if (brightest > kBrightestWanted)
        throw CaptureRefused({Cause::cameraSaturates,
                              "camera",
                              {},
                              "white is cut off even at its shortest exposure",
                              "close its aperture, lower its gain, or put a grey filter before it"});
    constexpr double kStep = 1.3;
    while (seconds_ < bench_.longestExposure()) {
        const double next = std::min(kStep * seconds_, bench_.longestExposure());
        const double seen = brightestOf(expose(white, next));
        if (seen > kBrightestWanted) return;
        seconds_ = next;
        brightest = seen;
    }
    if (brightest < kDimmestWanted)
        throw CaptureRefused({Cause::lightTooDark,
                              "camera",
                              {},
                              "full white is dark even at its longest exposure",
                              "open its aperture or raise its gain; see that the projectors are on and that it looks "
                              "at what they light"});
}

LightShot LightSeries::take(const LightShow& show) {
    LightShot shot;
    for (const double longer : kLonger)
        if (longer * seconds_ <= bench_.longestExposure() || shot.exposures.empty())
            shot.exposures.push_back(expose(show, longer * seconds_));
    return shot;
}

LightShot LightSeries::takeAll(const LightShow& show, double longest, double step, int count) {
    LightShot shot;
    for (int k = count - 1; k >= 0; --k) {
        const double seconds = longest * seconds_ * std::pow(step, -k);
        if (seconds >= bench_.shortestExposure() && seconds <= bench_.longestExposure())
            shot.exposures.push_back(expose(show, seconds));
    }
    return shot;
}

std::optional<double> lightBeyond(const LightShot& bright, const LightShot* dark, const CameraResponses& responses,
                                  std::size_t patch, int channel) {
    const CameraResponse& response = responses[static_cast<std::size_t>(channel)];
    for (std::size_t e = bright.exposures.size(); e-- > 0;) {
        const LightShot::Exposed& exposed = bright.exposures[e];
        const double byte = exposed.bytes[patch][channel];
        if (byte > kBrightestByte) continue;
        // Both at one exposure: what the response is wrong by cancels where they differ little.
        const double beyond = dark != nullptr ? response.lightOf(dark->exposures[e].bytes[patch][channel]) : 0.0;
        return (response.lightOf(byte) - beyond) / exposed.seconds;
    }
    return std::nullopt;
}

} // namespace lumorph
