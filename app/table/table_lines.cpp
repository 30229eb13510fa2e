#include "app/table/table_lines.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <sstream>
#include <system_error>
#include <thread>

#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "calibration/lab/board_lab.h"
#include "calibration/registration/touch_plan.h"
#include "core/base/error.h"

namespace lumorph::table {

namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr std::size_t kCorners = 20; // that are asked for: those of the fit and the check points
constexpr int kBoardPoses = 24;
constexpr double kLargestDot = 0.01; // of a projector's picture
constexpr double kJump = 0.02;       // metres
constexpr Microseconds kRests{400'000}, kMostRestless{8'000'000}, kMostLate{2'000'000};
constexpr std::chrono::milliseconds kLook{2};
constexpr int kVisible = 4, kRounded = 100; // of 255; so many may differ by more, and it is the same picture
constexpr double kAim = 0.35;               // of the way from a dot to the eye

/// Holes that are drilled in a corner of the table.
glm::dvec3 dimple(int number) { return {-0.3 + 0.06 * number, 0.0, 0.3}; }

/// More than a rounding of a few pixels.
bool looksOtherwise(const Image& a, const Image& b) {
    if (a.size() != b.size()) return true;
    int others = 0;
    for (std::size_t i = 0; i < a.pixels().size() && others <= kRounded; ++i)
        for (std::size_t channel = 0; channel < 3; ++channel)
            others += std::abs(a.pixels()[i][channel] - b.pixels()[i][channel]) > kVisible ? 1 : 0;
    return others > kRounded;
}

} // namespace

struct TableLines::Words {
    std::vector<std::string> all;

    [[nodiscard]] const std::string& at(std::size_t k) const {
        if (k >= all.size()) throw InvalidInput("line", "it ends too soon", std::string(help()));
        return all[k];
    }
    [[nodiscard]] double number(std::size_t k) const {
        const std::string& text = at(k);
        double value = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
            throw InvalidInput("\"" + text + "\"", "it is no number", "write one with a point, such as 0.25");
        return value;
    }
    [[nodiscard]] double numberOr(std::size_t k, double other) const { return k < all.size() ? number(k) : other; }
    [[nodiscard]] int count(std::size_t k) const { return static_cast<int>(std::lround(number(k))); }
    [[nodiscard]] glm::dvec3 place(std::size_t k) const { return {number(k), number(k + 1), number(k + 2)}; }
    [[nodiscard]] bool isOn(std::size_t k) const { return k >= all.size() || all[k] != "off"; }
};

TableLines::TableLines(TableParts parts) : parts_(parts) {}

std::string_view TableLines::help() {
    return "board N|off | touch dot|corner N|dimple N|X Y Z | swing dimple N | look X Y Z | aim | "
           "carry X Y Z [DEGREES [SECONDS]] | latency [TIMES] | hand X Y Z|off | cover on|off | fault KEY on|off | "
           "quit; places are "
           "metres, faults: tracker_dropout, tracker_swap, servo_jammed, servo_reversed, board_reset, "
           "camera_unplugged, auto_exposure, night_light, packets_lost PERCENT|off";
}

glm::dvec3 TableLines::dot() const {
    for (std::size_t k = 0; k < parts_.eye.watched().size(); ++k) {
        const auto picture = parts_.eye.at(k, SteadyClock().now()).picture;
        const cv::Mat rgba(picture->size().y, picture->size().x, CV_8UC4,
                           const_cast<Image::Pixel*>(picture->pixels().data()));
        cv::Mat grey, bright;
        cv::cvtColor(rgba, grey, cv::COLOR_RGBA2GRAY);
        double most = 0.0;
        cv::minMaxLoc(grey, nullptr, &most);
        if (most < 64.0) continue;
        cv::threshold(grey, bright, 0.5 * most, 255.0, cv::THRESH_BINARY);
        if (cv::countNonZero(bright) > kLargestDot * static_cast<double>(bright.total())) continue;
        const cv::Moments light = cv::moments(bright, true);
        const CalibratedCamera& camera = parts_.table.truth().room.projectors[k].camera;
        const glm::dvec3 from = positionOf(camera);
        const glm::dvec3 along = directionOf(camera, {light.m10 / light.m00, light.m01 / light.m00});
        if (along.y < -1e-6) return from - from.y / along.y * along;
    }
    throw InvalidInput("dot", "no projector shows a single spot of light now", "begin a step that shows one");
}

glm::dvec3 TableLines::placeOf(const Words& words, std::size_t first) const {
    const std::string& what = words.at(first);
    if (what == "dot") return dot();
    if (what == "dimple") return dimple(words.count(first + 1));
    if (what != "corner") return words.place(first);
    const auto corners = planLandmarks(*parts_.table.truth().rig, kCorners);
    const int number = words.count(first + 1);
    if (number < 1 || static_cast<std::size_t>(number) > corners.size())
        throw InvalidInput("corner " + std::to_string(number), "the device has none of that number",
                           "use 1 to " + std::to_string(corners.size()));
    const Pose device = parts_.table.at(SteadyClock().now()).device;
    return device * corners[static_cast<std::size_t>(number - 1)].onModel;
}

void TableLines::board(const Words& words) {
    if (!words.isOn(1)) return parts_.table.layBoard(std::nullopt);
    if (boardPoses_.empty()) {
        const TableTruth& truth = parts_.table.truth();
        boardPoses_ =
            BoardLab(truth.room, parseCalibrationBoard(truth.board), {}, truth.seed).possiblePoses(kBoardPoses);
    }
    const int number = words.count(1);
    if (number < 1 || static_cast<std::size_t>(number) > boardPoses_.size())
        throw InvalidInput("board " + std::to_string(number), "there is no such place for it",
                           "use 1 to " + std::to_string(boardPoses_.size()));
    parts_.table.layBoard(boardPoses_[static_cast<std::size_t>(number - 1)]);
}

void TableLines::touch(const Words& words) { parts_.table.touch(placeOf(words, 1), ++turns_); }

/// The tip between a dot and the eye, which is another one each time.
void TableLines::look(const Words& words) {
    if (words.at(0) == "look") return parts_.table.look(words.place(1), ++turns_);
    const glm::dvec3 mark = dot();
    const int k = ++turns_;
    const glm::dvec3 aside(k % 3 - 1, k % 2, (k / 3) % 3 - 1);
    const glm::dvec3 eye = glm::dvec3(parts_.table.truth().room.eye) + 0.06 * aside;
    parts_.table.look(eye, k);
    parts_.table.touch(mark + kAim * (eye - mark), k);
}

void TableLines::fault(const Words& words) {
    const std::string& key = words.at(1);
    const bool on = words.isOn(2);
    if (key == "tracker_dropout") return parts_.tracker.setDropsOut(on);
    if (key == "tracker_swap") return parts_.tracker.setSwapsBodies(on);
    if (key == "servo_jammed") return parts_.servos.setFault(on ? ServoPort::Fault::jammed : ServoPort::Fault::none);
    if (key == "servo_reversed")
        return parts_.servos.setFault(on ? ServoPort::Fault::reversed : ServoPort::Fault::none);
    if (key == "board_reset") return parts_.servos.reboot();
    const bool isCamera =
        key == "packets_lost" || key == "auto_exposure" || key == "night_light" || key == "camera_unplugged";
    if (!isCamera) throw InvalidInput("fault " + key, "the table has no such fault", std::string(help()));
    const double lost = key == "packets_lost" && on ? 0.01 * words.number(2) : 0.0; // before anything is changed
    for (const auto& camera : parts_.cameras) {
        if (key == "packets_lost") camera->losePackets(lost);
        if (key == "auto_exposure") camera->sensor().setSetsExposure(on);
        if (key == "night_light") camera->sensor().setSeesNightLight(on);
        if (key == "camera_unplugged") camera->setPlugged(!on);
    }
}

std::string TableLines::latency(const Words& words) {
    const SteadyClock clock;
    const auto times = static_cast<std::size_t>(std::clamp(words.all.size() > 1 ? words.count(1) : 12, 3, 100));
    const auto waitFor = [&clock](Microseconds most, const auto& holds) {
        for (const Microseconds begun = clock.now(); !holds(); std::this_thread::sleep_for(kLook))
            if (clock.now() - begun > most) return false;
        return true;
    };
    ScreenEye::Shown last = parts_.eye.at(0, clock.now());
    /// Since when it looks as it does; a pixel here and there that is rounded otherwise is no other picture.
    const auto changed = [&] {
        const ScreenEye::Shown now = parts_.eye.at(0, clock.now());
        if (now.picture != last.picture && looksOtherwise(*now.picture, *last.picture)) last = now;
        return last.since;
    };
    parts_.tracker.setTrembles(false); // its noise would move the picture all the time
    const std::shared_ptr<void> trembles(nullptr, [this](void*) { parts_.tracker.setTrembles(true); });
    const Pose lies = parts_.table.at(clock.now()).device;
    const double turn = 2.0 * std::atan2(lies.rotation.y, lies.rotation.w);
    const std::shared_ptr<void> back(nullptr, [&](void*) { parts_.table.carry(lies.position, turn, 0.5); });
    std::vector<double> late;
    while (late.size() < times) {
        if (!waitFor(kMostRestless, [&] { return clock.now() - changed() > kRests; }))
            throw InvalidInput("latency", "the picture on the screen does not come to rest",
                               "pause what moves in the show");
        const Microseconds moved = clock.now();
        const double aside = late.size() % 2 == 0 ? kJump : 0.0;
        parts_.table.carry(lies.position + glm::dvec3(aside, 0.0, 0.0), turn, 0.0);
        std::optional<Microseconds> sent;
        const auto follows = [&] {
            if (!sent) sent = parts_.tracker.sentAfter(moved);
            return sent && changed() > *sent;
        };
        if (!waitFor(kMostLate, follows))
            throw InvalidInput("latency", "the picture on the screen does not follow the device",
                               "track it, and show something on it");
        late.push_back(1e-3 * static_cast<double>((changed() - *sent).count()));
    }
    std::ranges::sort(late);
    nlohmann::ordered_json said{{"ok", true}};
    said["sent_to_pixels_ms"] = {
        {"median", late[late.size() / 2]}, {"least", late.front()}, {"most", late.back()}, {"jumps", late.size()}};
    said["light_ms"] = 1e3 * parts_.table.truth().room.predictionSeconds;
    return said.dump();
}

std::string TableLines::answer(std::string_view line) {
    nlohmann::ordered_json said;
    try {
        Words words;
        std::istringstream text{std::string(line)};
        for (std::string word; text >> word;) words.all.push_back(word);
        const std::string& order = words.at(0);
        if (order == "board")
            board(words);
        else if (order == "touch")
            touch(words);
        else if (order == "swing")
            parts_.table.swing(placeOf(words, 1));
        else if (order == "look" || order == "aim")
            look(words);
        else if (order == "carry")
            parts_.table.carry(words.place(1), kDegree * words.numberOr(4, 0.0), words.numberOr(5, 1.0));
        else if (order == "hand")
            parts_.table.holdHand(words.isOn(1) ? std::optional(words.place(1)) : std::nullopt);
        else if (order == "cover")
            parts_.table.cover(words.isOn(1));
        else if (order == "fault")
            fault(words);
        else if (order == "latency")
            return latency(words);
        else if (order == "quit")
            ended_ = true;
        else
            throw InvalidInput("\"" + order + "\"", "it is no order", std::string(help()));
        said["ok"] = true;
    } catch (const std::exception& error) {
        said = {{"ok", false}, {"error", error.what()}};
    }
    return said.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

} // namespace lumorph::table
