#include "calibration/doctor/device_capture.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <sstream>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "calibration/decode/capture_folder.h"
#include "calibration/doctor/sequence_check.h"
#include "calibration/doctor/stripe_check.h"
#include "calibration/doctor/view_check.h"
#include "core/base/error.h"
#include "core/base/file.h"

namespace lumorph {

namespace {

constexpr int kMostCells = 40'000; // of a picture: a flap that fills a two-hundredth of it must show in many

namespace fs = std::filesystem;

constexpr std::size_t kMostTableBytes = std::size_t{1} << 20;

/// What one camera saw of one projector in one shot.
struct ShotView {
    std::size_t shot = 0, camera = 0, projector = 0;
    CapturedView images;
    cv::Size size{};
    std::vector<ProjectorPoint> light{};
    std::optional<Finding> refusal{}, warning{};
};

std::string trimmed(std::string text) {
    text.erase(0, text.find_first_not_of(" \t\r\""));
    text.erase(text.find_last_not_of(" \t\r\"") + 1);
    return text;
}

std::vector<std::string> fieldsOf(const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream stream(line + ","); // an empty last field counts
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(trimmed(field));
    return fields;
}

DeviceShot shotOf(const std::vector<std::string>& fields, std::size_t actuators, const std::string& place) {
    if (fields.size() != actuators + 1)
        throw DataError(place,
                        "it has " + std::to_string(fields.size() - 1) + " strokes, the rig " +
                            std::to_string(actuators) + " actuators",
                        "write the shot's folder and a stroke for each actuator, separated by commas");
    DeviceShot shot{fields.front(), {}, {}};
    for (const std::string& field : std::span(fields).subspan(1)) {
        double stroke = 0.0;
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), stroke);
        if (error != std::errc() || end != field.data() + field.size() || !(stroke >= 0.0 && stroke <= 1.0))
            throw DataError(place, "'" + field + "' is no stroke",
                            "write numbers from 0 (at rest) to 1 (raised as far as it goes)");
        shot.strokes.push_back(stroke);
    }
    return shot;
}

/// The shots of the table, which are exactly those of the folders.
std::vector<DeviceShot> statesIn(const fs::path& folder, std::size_t actuators) {
    std::vector<std::string> names;
    for (const fs::path& entry : foldersIn(folder)) names.push_back(entry.filename().string());
    const fs::path file = folder / kStatesFile;
    const std::vector<std::byte> bytes = readFile(file, kMostTableBytes);
    std::istringstream lines(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    std::vector<DeviceShot> shots;
    std::string line;
    for (std::size_t number = 1; std::getline(lines, line); ++number) {
        if (trimmed(line).empty()) continue;
        const std::vector<std::string> fields = fieldsOf(line);
        if (number == 1 && fields.front() == "shot") continue;
        const std::string place = file.string() + ", line " + std::to_string(number);
        DeviceShot shot = shotOf(fields, actuators, place);
        if (std::ranges::find(names, shot.name) == names.end())
            throw DataError(place, "there is no folder '" + shot.name + "'",
                            "correct the name, or strike the line out");
        if (std::ranges::find(shots, shot.name, &DeviceShot::name) != shots.end())
            throw DataError(place, "'" + shot.name + "' stands in a line before", "write one line a shot");
        shots.push_back(std::move(shot));
    }
    for (const std::string& name : names)
        if (std::ranges::find(shots, name, &DeviceShot::name) == shots.end())
            throw DataError(file.string(), "it lacks the shot '" + name + "'",
                            "add a line with its strokes, or take the folder away");
    if (shots.empty()) throw DataError(file.string(), "it has no shot", "write one line a shot");
    return shots;
}

bool holdsImages(const fs::path& folder) {
    try {
        return !imagesIn(folder).empty();
    } catch (const DataError&) {
        return false;
    }
}

/// The place of a name in a list, to which it is added where it is not there.
std::size_t placeOf(const std::string& name, std::vector<NamedDevice>& devices) {
    const auto at = std::ranges::find(devices, name, &NamedDevice::name);
    if (at != devices.end()) return static_cast<std::size_t>(at - devices.begin());
    devices.push_back({name, {}});
    return devices.size() - 1;
}

std::vector<ShotView> shotViews(const fs::path& folder, const std::vector<DeviceShot>& shots,
                                const std::vector<NamedOrder>& projectors, std::vector<NamedDevice>& cameras) {
    std::vector<ShotView> views;
    for (std::size_t s = 0; s < shots.size(); ++s) {
        const fs::path shot = folder / shots[s].name;
        if (holdsImages(shot)) {
            if (projectors.size() != 1)
                throw DataError(shot.string(), "its images are of one projector, but several were named",
                                "put them into CAMERA/PROJECTOR in it, or name one projector");
            views.push_back({s, placeOf("camera", cameras), 0, {shots[s].name, imagesIn(shot)}});
            continue;
        }
        for (const fs::path& camera : foldersIn(shot))
            for (const fs::path& projector : foldersIn(camera)) {
                const auto named = std::ranges::find(projectors, projector.filename().string(), &NamedOrder::name);
                if (named == projectors.end())
                    throw DataError(projector.string(), "no projector of this name was given",
                                    "give --projector NAME=WIDTHxHEIGHT for each, or correct the folder's name");
                const std::string name = camera.filename().string();
                views.push_back({s,
                                 placeOf(name, cameras),
                                 static_cast<std::size_t>(named - projectors.begin()),
                                 {shots[s].name + "/" + name + "/" + named->name, imagesIn(projector)}});
            }
    }
    return views;
}

/// Each shot has the pictures that any other has, and each projector has some.
void requireWhole(const fs::path& folder, const std::vector<ShotView>& views, const std::vector<DeviceShot>& shots,
                  const std::vector<NamedDevice>& cameras, const std::vector<NamedOrder>& projectors) {
    for (std::size_t p = 0; p < projectors.size(); ++p) {
        if (std::ranges::find(views, p, &ShotView::projector) == views.end())
            throw DataError(folder.string(), "it holds no images of projector '" + projectors[p].name + "'",
                            "name the folders CAMERA/" + projectors[p].name + " in each shot");
        for (std::size_t c = 0; c < cameras.size(); ++c) {
            const auto isOf = [&](const ShotView& view) { return view.projector == p && view.camera == c; };
            if (std::ranges::none_of(views, isOf)) continue;
            for (std::size_t s = 0; s < shots.size(); ++s)
                if (std::ranges::none_of(views, [&](const ShotView& view) { return isOf(view) && view.shot == s; }))
                    throw DataError((folder / shots[s].name).string(),
                                    "it lacks the images of projector '" + projectors[p].name + "' by camera '" +
                                        cameras[c].name + "' that other shots have",
                                    "add them, or take the shot out of folder and " + std::string(kStatesFile));
        }
    }
}

/// The device need not reach the edges of the projector's picture, so only what lies past them tells of another size.
std::optional<Finding> lightPastTheEdge(const std::string& view, const DecodedView& decoded, cv::Size projector) {
    constexpr double kMost = 0.01; // of the light: codes that were misread
    int known = 0, past = 0;
    for (int y = 0; y < decoded.column.rows; ++y)
        for (int x = 0; x < decoded.column.cols; ++x) {
            if (!std::isfinite(decoded.column(y, x)) || !std::isfinite(decoded.row(y, x))) continue;
            ++known;
            past += decoded.column(y, x) > projector.width - 0.4 || decoded.row(y, x) > projector.height - 0.4 ? 1 : 0;
        }
    if (past <= kMost * known) return std::nullopt;
    return Finding{Cause::projectorSize, view, "",
                   "the patterns reach past the edge of " + std::to_string(projector.width) + " x " +
                       std::to_string(projector.height),
                   "give the size of the projector that the patterns were made for"};
}

void readView(ShotView& view, const CaptureOrder& order) {
    const auto throwIf = [](const std::optional<Finding>& finding) {
        if (finding) throw CaptureRefused(*finding);
    };
    const std::vector<cv::Mat> images = readImages(view.images);
    view.size = images.front().size();
    throwIf(checkSequence(view.images, images, order));
    throwIf(checkStripes(view.images, images, order));
    const DecodedView decoded = decodeView(images, order);
    throwIf(lightPastTheEdge(view.images.name, decoded, order.projector));
    view.warning = checkLight(view.images.name, decoded);
    if (view.warning) view.warning->why = "much of what the projector lights is overexposed";
    view.light = lightOf(decoded, kMostCells);
}

void readAll(std::vector<ShotView>& views, const std::vector<NamedOrder>& projectors, const Progress& progress) {
    std::atomic<int> done = 0;
    tbb::task_arena arena(2); // each view holds all its images
    arena.execute([&] {
        tbb::parallel_for(std::size_t{0}, views.size(), [&](std::size_t i) {
            if (progress.cancelled()) return;
            try {
                readView(views[i], projectors[views[i].projector].order);
            } catch (const CaptureRefused& why) {
                views[i].refusal = why.finding();
            }
            progress.report(++done / static_cast<double>(views.size()), "reading shots");
        });
    });
    progress.throwIfCancelled();
    for (const ShotView& view : views) // the first of them, whichever was read first
        if (view.refusal) throw CaptureRefused(*view.refusal);
}

} // namespace

DeviceCapture readDeviceCapture(const std::filesystem::path& folder, std::size_t actuators,
                                const std::vector<NamedOrder>& projectors, const Progress& progress) {
    DeviceCapture capture;
    capture.shots = statesIn(folder, actuators);
    std::vector<ShotView> views = shotViews(folder, capture.shots, projectors, capture.cameras);
    requireWhole(folder, views, capture.shots, capture.cameras, projectors);
    for (std::size_t p = 0; p < projectors.size(); ++p) {
        std::vector<CapturedView> images;
        for (const ShotView& view : views)
            if (view.projector == p) images.push_back(view.images);
        if (const auto wrong = checkCounts(images, projectors[p].order)) throw CaptureRefused(*wrong);
    }
    readAll(views, projectors, progress);
    for (DeviceShot& shot : capture.shots)
        shot.light.assign(capture.cameras.size(), std::vector<std::vector<ProjectorPoint>>(projectors.size()));
    for (ShotView& view : views) {
        cv::Size& size = capture.cameras[view.camera].size;
        if (size.empty()) size = view.size;
        if (size != view.size)
            throw CaptureRefused({Cause::imageSize, view.images.name, "",
                                  "its images have another size than those of the camera before",
                                  "capture all shots with one camera setting"});
        if (view.warning) capture.warnings.push_back(*view.warning);
        capture.shots[view.shot].light[view.camera][view.projector] = std::move(view.light);
    }
    return capture;
}

} // namespace lumorph
