#include "calibration/light/light_calibration.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "calibration/lab/lab_light.h"
#include "calibration/light/light_fit.h"
#include "core/base/error.h"
#include "core/scene/projector_response.h"

namespace lumorph {

namespace {

using light::ChannelLight;
using light::ProjectorShots;
using light::WhiteFit;

constexpr int kRampSteps = 16;
constexpr std::size_t kFewestOnSurface = 4; // patches
constexpr std::size_t kResponsePlaces = 60;
constexpr int kReferenceGrey = 128;
constexpr int kDimGrey = 96;             // whose longer exposures tell the camera's darker bytes
constexpr double kGreyDrift = 0.02;      // of the light of a grey, between the first photographs and later ones
constexpr double kAmbientDrift = 0.003;  // of white
constexpr double kMostFreshError = 0.05; // in 95 of 100 places: more is no noise
constexpr double kJudgedLight = 0.03;    // of white: darker light is judged by that
constexpr std::array<int, 5> kFreshGreys = {40, 77, 121, 168, 219}; // of 255, between the steps of the ramps

/// As often as it is looked whether camera and room are as they were.
struct ReferenceShots {
    LightShot dark, grey;
};

/// Light that is sent and was photographed, for the judge.
struct FreshShot {
    std::vector<int> greys; ///< one a projector
    LightShot shot;
};

std::string percents(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f %%", 100.0 * share);
    return text;
}

class LightMeasurement {
public:
    LightMeasurement(const Installation& believed, const std::vector<LightPatch>& patches, LightBench& bench,
                     const Progress& progress)
        : believed_(believed), patches_(patches), progress_(progress), series_(bench, patches) {
        for (std::size_t p = 0; p < believed.projectors.size(); ++p)
            if (believed.projectors[p].enabled) on_.push_back(p);
        if (on_.empty()) throw InvalidInput("measurement of light", "no projector is on", "switch one on");
        result_.room = believed;
    }

    LightCalibration measure() {
        try {
            lookAtPatches();
            photograph();
            solve();
        } catch (const CaptureRefused& refused) {
            result_.room = believed_;
            result_.refusal = refused.finding();
        }
        result_.photographs = series_.photographs();
        return std::move(result_);
    }

private:
    [[nodiscard]] LightShow showing(const glm::ivec3& color) const {
        return {believed_.projectors.size(), std::optional<glm::ivec3>(color)};
    }
    [[nodiscard]] std::size_t countOf(LightSurface surface) const {
        return static_cast<std::size_t>(std::ranges::count(patches_, surface, &LightPatch::surface));
    }
    void lookAtPatches();
    void photograph();
    ReferenceShots reference();
    void learnResponses();
    ProjectorShots shotsOf(std::size_t projector, const Progress& progress);
    void lookForDrift();

    void solve();
    void applyWhites(WhiteFit fit, const std::vector<std::array<ChannelLight, 3>>& channels);
    void judge(const WhiteFit& fit, const glm::dmat3& mixing);
    [[nodiscard]] FreshLight judged(const Installation& room, const WhiteFit& fit, const glm::dmat3& mixing) const;
    void tell();

    const Installation& believed_;
    const std::vector<LightPatch>& patches_;
    const Progress& progress_;
    LightSeries series_;
    std::vector<std::size_t> on_;
    CameraResponses responses_;
    std::vector<ReferenceShots> references_;
    std::vector<ProjectorShots> shots_;
    glm::dvec3 unknownTint_{1.0}; ///< of a camera without colour: what its channels' gains were divided by
    LightShot freshDark_;
    std::vector<FreshShot> fresh_;
    LightCalibration result_;
};

void LightMeasurement::lookAtPatches() {
    if (countOf(LightSurface::device) < kFewestOnSurface)
        throw CaptureRefused({Cause::surfaceUnseen,
                              "device",
                              {},
                              "the camera hardly sees it in the projectors' light",
                              "turn camera and projector to the device, and take away what covers it"});
    for (const std::size_t p : on_)
        if (std::ranges::count_if(patches_, [p](const LightPatch& patch) { return patch.shares[p] > 0.0; }) <
            static_cast<std::ptrdiff_t>(kFewestOnSurface))
            throw CaptureRefused({Cause::surfaceUnseen,
                                  believed_.projectors[p].name,
                                  {},
                                  "the camera sees hardly anything that it lights",
                                  "turn the camera to what it lights, or switch the projector off"});
    if (countOf(LightSurface::table) < kFewestOnSurface)
        result_.warnings.push_back({Cause::surfaceUnseen,
                                    "table",
                                    {},
                                    "the camera hardly sees it in the projectors' light, so its colour stays as it was",
                                    "let the camera see some of the table beside the device"});
}

ReferenceShots LightMeasurement::reference() {
    progress_.throwIfCancelled();
    return {series_.take(showing(glm::ivec3(0))), series_.take(showing(glm::ivec3(kReferenceGrey)))};
}

/// Of some patches, evenly chosen: they only have to differ. The longest exposures cut off the brightest of them, so
/// that the others tell of the highest bytes as well.
void LightMeasurement::learnResponses() {
    const LightShot white = series_.takeAll(showing(glm::ivec3(255)), 2.4, 1.6, 12);
    progress_.throwIfCancelled();
    const LightShot dim = series_.takeAll(showing(glm::ivec3(kDimGrey)), 20.0, 1.55, 11);
    const std::size_t step = std::max<std::size_t>(1, patches_.size() / kResponsePlaces);
    double squares = 0.0;
    for (int channel = 0; channel < 3; ++channel) {
        std::vector<ExposedByte> seen;
        std::size_t place = 0;
        for (const LightShot* shot : {&white, &dim})
            for (std::size_t i = 0; i < patches_.size(); i += step, ++place)
                for (const LightShot::Exposed& exposed : shot->exposures)
                    seen.push_back({place, exposed.seconds, exposed.bytes[i][channel]});
        CameraResponse& response = responses_[static_cast<std::size_t>(channel)];
        response = estimateCameraResponse(seen);
        squares += response.rms() * response.rms();
    }
    result_.responseRms = std::sqrt(squares / 3.0);
}

ProjectorShots LightMeasurement::shotsOf(std::size_t projector, const Progress& progress) {
    ProjectorShots shots;
    shots.projector = projector;
    LightShow show = showing(glm::ivec3(0));
    show[projector].reset();
    // To cover the lens is asked by the bench, once it knows how bright it is uncovered.
    progress.report(0.0, "photographing black of " + believed_.projectors[projector].name);
    shots.covered = series_.take(show);
    show[projector] = glm::ivec3(0);
    shots.dark = series_.take(show);
    for (int k = 1; k <= kRampSteps; ++k) {
        progress.report(static_cast<double>(k) / (kRampSteps + 1), "photographing flat light");
        const int value = 255 * k / kRampSteps;
        shots.values.push_back(value / 255.0);
        std::array<LightShot, 3>& row = shots.ramp.emplace_back();
        for (int channel = 0; channel < 3; ++channel) {
            progress.throwIfCancelled();
            glm::ivec3 color(0);
            color[channel] = value;
            show[projector] = color;
            row[static_cast<std::size_t>(channel)] = series_.take(show);
        }
    }
    return shots;
}

void LightMeasurement::photograph() {
    progress_.report(0.0, "setting the camera's exposure");
    series_.setExposure(showing(glm::ivec3(255)));
    progress_.report(0.05, "photographing white at several exposures");
    learnResponses();
    references_.push_back(reference());
    for (std::size_t k = 0; k < on_.size(); ++k) {
        const auto of = [&](std::size_t n) {
            return 0.15 + 0.7 * static_cast<double>(n) / static_cast<double>(on_.size());
        };
        shots_.push_back(shotsOf(on_[k], progress_.part(of(k), of(k + 1))));
        references_.push_back(reference());
        lookForDrift();
    }
    progress_.report(0.9, "photographing fresh greys");
    freshDark_ = references_.back().dark;
    for (std::size_t k = 0; k < kFreshGreys.size(); ++k) {
        FreshShot fresh;
        LightShow show;
        for (std::size_t p = 0; p < believed_.projectors.size(); ++p) {
            fresh.greys.push_back(kFreshGreys[(k + 2 * p) % kFreshGreys.size()]);
            show.emplace_back(glm::ivec3(fresh.greys.back()));
        }
        fresh.shot = series_.take(show);
        fresh_.push_back(std::move(fresh));
    }
}

/// What the last reference has beyond the first: light of the room adds to all, a camera multiplies.
void LightMeasurement::lookForDrift() {
    const ReferenceShots &first = references_.front(), &last = references_.back();
    double darkThen = 0.0, darkNow = 0.0, greyThen = 0.0, greyNow = 0.0;
    for (std::size_t i = 0; i < patches_.size(); ++i)
        for (int channel = 0; channel < 3; ++channel) {
            darkThen += lightBeyond(first.dark, nullptr, responses_, i, channel).value_or(0.0);
            darkNow += lightBeyond(last.dark, nullptr, responses_, i, channel).value_or(0.0);
            greyThen += lightBeyond(first.grey, &first.dark, responses_, i, channel).value_or(0.0);
            greyNow += lightBeyond(last.grey, &last.dark, responses_, i, channel).value_or(0.0);
        }
    const double drift = greyNow / greyThen - 1.0;
    // A grey in the middle is about a fifth of white.
    const double white = 5.0 * greyThen;
    const double shift = (darkNow - darkThen * (1.0 + drift)) / white;
    if (std::abs(shift) > kAmbientDrift)
        throw CaptureRefused({Cause::ambientChanges,
                              "room",
                              {},
                              "its light became " + std::string(shift > 0.0 ? "brighter" : "darker") + " by " +
                                  percents(std::abs(shift)) + " of white meanwhile",
                              "leave lamps and curtains as they are, and measure again"});
    if (std::abs(drift) > kGreyDrift)
        throw CaptureRefused({Cause::cameraAdjusts,
                              "camera",
                              {},
                              "the same grey became " + std::string(drift > 0.0 ? "brighter" : "darker") + " by " +
                                  percents(std::abs(drift)) + " meanwhile",
                              "switch off the camera's automatic exposure and gain; let projectors warm up for a "
                              "quarter of an hour"});
}

/// Splits products of gain and albedo, and says by what.
void LightMeasurement::applyWhites(WhiteFit fit, const std::vector<std::array<ChannelLight, 3>>& channels) {
    const auto at = [&](LightSurface surface) -> glm::dvec3& { return fit.albedo[static_cast<std::size_t>(surface)]; };
    const auto meanOf = [](const glm::dvec3& color) { return (color.r + color.g + color.b) / 3.0; };
    result_.hasWhiteSheet = countOf(LightSurface::sheet) >= kFewestOnSurface;
    LightSurface white = LightSurface::sheet;
    if (!result_.hasWhiteSheet)
        white = meanOf(at(LightSurface::table)) > meanOf(at(LightSurface::device)) ? LightSurface::table
                                                                                   : LightSurface::device;
    glm::dvec3 unit = at(white);
    // No surface gives back more than white: where one seems to, the sheet is grey, and only its tint is believed.
    double most = 1.0;
    for (const LightSurface surface : {LightSurface::device, LightSurface::table})
        for (int channel = 0; channel < 3; ++channel) most = std::max(most, at(surface)[channel] / unit[channel]);
    unit *= most;
    double logs = 0.0;
    for (std::size_t k = 0; k < on_.size(); ++k)
        for (int channel = 0; channel < 3; ++channel) {
            const double black = channels[k][static_cast<std::size_t>(channel)].black;
            double& gain = fit.gains[on_[k]][channel];
            gain *= unit[channel] / (1.0 - black);
            logs += std::log(gain);
        }
    const double mean = std::exp(logs / (3.0 * static_cast<double>(on_.size())));
    // How much more a camera without colour sees of red than of blue nobody knows: only what projectors differ by
    // counts.
    if (series_.isMonochrome())
        for (int channel = 0; channel < 3; ++channel) {
            double own = 0.0;
            for (const std::size_t p : on_) own += std::log(fit.gains[p][channel] / mean);
            unknownTint_[channel] = std::exp(own / static_cast<double>(on_.size()));
        }
    Installation& room = result_.room;
    const Origin origin{Origin::Way::measured, "flat light, " + std::to_string(series_.photographs()) + " photographs",
                        utcDate()};
    for (std::size_t k = 0; k < on_.size(); ++k) {
        InstalledProjector& projector = room.projectors[on_[k]];
        projector.gain = glm::vec3(fit.gains[on_[k]] / (mean * unknownTint_));
        projector.responseCurve = light::curveOf(shots_[k].values, channels[k]);
        for (int channel = 0; channel < 3; ++channel)
            projector.black[channel] = static_cast<float>(channels[k][static_cast<std::size_t>(channel)].black);
        projector.response = origin;
    }
    const auto colorOf = [&](LightSurface surface) {
        const glm::dvec3 albedo = at(surface) / unit;
        return glm::vec3(srgbOfLight(albedo.r), srgbOfLight(albedo.g), srgbOfLight(albedo.b));
    };
    room.deviceColor = colorOf(LightSurface::device);
    if (countOf(LightSurface::table) >= kFewestOnSurface) room.tableColor = colorOf(LightSurface::table);
    room.origins.colors = origin;
    result_.assumption =
        result_.hasWhiteSheet
            ? "White is what the sheet of paper is. How bright the light is as a whole a camera cannot tell: gains are "
              "relative, their mean is 1. What the camera shows as neutral is taken to be neutral."
            : std::string(
                  "Without a white sheet the tint of the light cannot be told from that of what it falls on: ") +
                  (white == LightSurface::table ? "the table" : "the device") +
                  " is taken to be white, and its tint is among the projectors' gains. What is projected comes out "
                  "right all the same. Gains are relative, their mean is 1; what the camera shows as neutral is taken "
                  "to be neutral.";
    if (series_.isMonochrome())
        result_.assumption += " The camera sees no colour: the tint that all projectors share is taken to be neutral.";
}

/// How far a room's prediction is from fresh light, apart from how bright all of it is.
FreshLight LightMeasurement::judged(const Installation& room, const WhiteFit& fit, const glm::dmat3& mixing) const {
    struct Pair {
        double predicted, seen, white;
    };
    std::vector<Pair> pairs;
    const std::array<glm::dvec3, 2> albedo{glm::dvec3(lightOfSrgb(room.deviceColor)),
                                           glm::dvec3(lightOfSrgb(room.tableColor))};
    for (const FreshShot& fresh : fresh_)
        for (std::size_t i = 0; i < patches_.size(); ++i) {
            if (patches_[i].surface == LightSurface::sheet) continue;
            glm::dvec3 light(0.0), white(0.0);
            for (const std::size_t p : on_) {
                const InstalledProjector& projector = room.projectors[p];
                const glm::dvec3 full = patches_[i].shares[p] * glm::dvec3(projector.gain) *
                                        (1.0 - glm::dvec3(projector.black)) *
                                        albedo[static_cast<std::size_t>(patches_[i].surface)];
                light += full * lightOfValue(projector, fresh.greys[p] / 255.0);
                white += full;
            }
            light = mixing * (unknownTint_ * light);
            white = mixing * (unknownTint_ * white);
            for (int channel = 0; channel < 3; ++channel) {
                const auto seen = lightBeyond(fresh.shot, &freshDark_, responses_, i, channel);
                if (!seen || !(*seen > 0.0)) continue;
                const double fading = fit.fadingOf(patches_[i], channel);
                pairs.push_back({fading * light[channel], *seen, fading * white[channel]});
            }
        }
    FreshLight result{0.0, 0.0, pairs.size()};
    if (pairs.empty()) return result;
    const auto quantile = [](std::vector<double> numbers, double share) {
        const auto place =
            numbers.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(numbers.size() - 1));
        std::ranges::nth_element(numbers, place);
        return *place;
    };
    std::vector<double> ratios, errors;
    for (const Pair& pair : pairs) ratios.push_back(pair.seen / pair.predicted);
    const double scale = quantile(ratios, 0.5);
    for (const Pair& pair : pairs)
        errors.push_back(std::abs(scale * pair.predicted - pair.seen) /
                         std::max(pair.seen, kJudgedLight * scale * pair.white));
    result.median = quantile(errors, 0.5);
    result.most = quantile(errors, 0.95);
    return result;
}

void LightMeasurement::judge(const WhiteFit& fit, const glm::dmat3& mixing) {
    result_.fresh = judged(result_.room, fit, mixing);
    result_.before = judged(believed_, fit, mixing);
    if (result_.fresh.places == 0 || result_.fresh.most > kMostFreshError)
        throw CaptureRefused(
            {Cause::freshPointsFar,
             "light",
             {},
             "greys that the fit did not see are off by " + percents(result_.fresh.most) + " in 95 of 100 places",
             "switch off what the projector makes of pictures by itself (white boost, dynamic "
             "contrast), and measure again"});
}

void LightMeasurement::solve() {
    std::vector<std::array<ChannelLight, 3>> channels;
    for (const ProjectorShots& shots : shots_)
        channels.push_back(light::channelsOf(shots, patches_, responses_, believed_.projectors[shots.projector].name));
    const WhiteFit fit = light::fitWhites(shots_, patches_, responses_, believed_.projectors.size());
    const glm::dmat3 mixing = light::mixingOf(shots_, patches_, responses_);
    applyWhites(fit, channels);
    judge(fit, mixing);
    tell();
}

void LightMeasurement::tell() {
    double dark = 0.0, white = 0.0;
    for (std::size_t i = 0; i < patches_.size(); ++i) {
        if (!(patches_[i].shares[on_.front()] > 0.0)) continue;
        dark += lightBeyond(shots_.front().dark, nullptr, responses_, i, 1).value_or(0.0);
        white += lightBeyond(shots_.front().ramp.back()[1], &shots_.front().dark, responses_, i, 1).value_or(0.0);
    }
    result_.ambient = dark / white;
    char text[200];
    std::snprintf(text, sizeof text,
                  "fresh greys are met to %.2f %% (median), %.1f %% in 95 of 100 places; by what was believed %.1f %% "
                  "and %.1f %%",
                  100.0 * result_.fresh.median, 100.0 * result_.fresh.most, 100.0 * result_.before.median,
                  100.0 * result_.before.most);
    result_.figures.emplace_back(text);
    std::snprintf(text, sizeof text, "exposures contradict the camera's curve by %.2f %% of the light",
                  100.0 * result_.responseRms);
    result_.figures.emplace_back(text);
    for (const std::size_t p : on_) {
        const InstalledProjector& projector = result_.room.projectors[p];
        std::snprintf(text, sizeof text, "gains %.3f %.3f %.3f, black 1:%.0f", static_cast<double>(projector.gain.r),
                      static_cast<double>(projector.gain.g), static_cast<double>(projector.gain.b),
                      1.0 / std::max(1e-5, static_cast<double>(projector.black.g)));
        result_.figures.push_back(projector.name + ": " + text);
    }
}

} // namespace

LightCalibration measureLight(const Installation& believed, const std::vector<LightPatch>& patches, LightBench& bench,
                              const Progress& progress) {
    return LightMeasurement(believed, patches, bench, progress).measure();
}

} // namespace lumorph
