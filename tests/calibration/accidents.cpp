#include "tests/calibration/accidents.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace lumorph::test {
namespace {

using Images = std::vector<cv::Mat>;
using Patterns = Accident::Patterns;

int within(std::mt19937& dice, int low, int high) { return std::uniform_int_distribution<int>(low, high)(dice); }

double between(std::mt19937& dice, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(dice);
}

double sign(std::mt19937& dice) { return dice() % 2 == 0 ? 1.0 : -1.0; }

std::size_t anyPose(const SpoiledCapture& capture, std::mt19937& dice) { return dice() % capture.poses.size(); }

cv::Mat scaled(const cv::Mat& image, double gain, double shift = 0.0) {
    cv::Mat changed;
    image.convertTo(changed, CV_8U, gain, shift);
    return changed;
}

cv::Mat raised(const cv::Mat& image, double power) {
    cv::Mat1b curve(1, 256);
    for (int i = 0; i < 256; ++i) curve(0, i) = cv::saturate_cast<uchar>(255.0 * std::pow(i / 255.0, power));
    cv::Mat changed;
    cv::LUT(image, curve, changed);
    return changed;
}

cv::Mat withNoise(const cv::Mat& image, double sigma, std::mt19937& dice) {
    cv::Mat noise(image.size(), CV_32F), changed;
    cv::theRNG().state = dice();
    cv::randn(noise, 0.0, sigma);
    image.convertTo(changed, CV_32F);
    changed += noise;
    changed.convertTo(changed, CV_8U);
    return changed;
}

cv::Mat blurred(const cv::Mat& image, double sigma) {
    cv::Mat changed;
    cv::GaussianBlur(image, changed, {}, sigma);
    return changed;
}

cv::Mat warped(const cv::Mat& image, const cv::Matx33d& toPlace) {
    cv::Mat changed;
    cv::warpPerspective(image, changed, toPlace, image.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    return changed;
}

/// A picture turned and moved about its middle, and enlarged.
cv::Matx33d moved(cv::Size size, double degrees, cv::Point2d by, double zoom = 1.0) {
    const double a = zoom * std::cos(degrees * std::numbers::pi / 180.0);
    const double b = zoom * std::sin(degrees * std::numbers::pi / 180.0);
    const double x = 0.5 * (size.width - 1);
    const double y = 0.5 * (size.height - 1);
    return {a, -b, x - a * x + b * y + by.x, b, a, y - b * x - a * y + by.y, 0.0, 0.0, 1.0};
}

cv::Mat asJpeg(const cv::Mat& image, int quality) {
    std::vector<uchar> bytes;
    cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
    return cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
}

void forAll(SpoiledCapture& capture, const std::function<cv::Mat(const cv::Mat&)>& change) {
    for (Images& pose : capture.poses)
        for (cv::Mat& image : pose) image = change(image);
}

/// Without its rim, into which nothing comes from outside when a picture is moved.
void crop(SpoiledCapture& capture) {
    const int rim = capture.camera().width / 30;
    forAll(capture, [rim](const cv::Mat& image) {
        return image(cv::Rect(rim, rim, image.cols - 2 * rim, image.rows - 2 * rim)).clone();
    });
}

void forPose(SpoiledCapture& capture, std::size_t pose, const std::function<cv::Mat(const cv::Mat&)>& change) {
    for (cv::Mat& image : capture.poses[pose]) image = change(image);
}

/// The first image of a pattern; -1 where there is none.
int placeOf(const CaptureOrder& order, const PatternImage& wanted) {
    const auto found = std::ranges::find(order.images, wanted);
    return found == order.images.end() ? -1 : static_cast<int>(found - order.images.begin());
}

int bitsOf(const CaptureOrder& order, PatternAxis axis) {
    int bits = 0;
    for (const PatternImage& image : order.images)
        if (const auto* gray = std::get_if<GrayBit>(&image); gray != nullptr && gray->axis == axis)
            bits = std::max(bits, gray->bit + 1);
    return bits;
}

/// Takes the images in another order than they were projected in: place i gets what stands at `from(i)`.
void reorder(Images& images, const std::function<int(int)>& from) {
    const Images before = images;
    for (std::size_t i = 0; i < images.size(); ++i) {
        const int other = from(static_cast<int>(i));
        if (other >= 0) images[i] = before[static_cast<std::size_t>(other)];
    }
}

void exchangeBits(SpoiledCapture& capture, int one, int other) {
    for (Images& pose : capture.poses)
        reorder(pose, [&](int i) {
            const auto* gray = std::get_if<GrayBit>(&capture.order.images[static_cast<std::size_t>(i)]);
            if (gray == nullptr || gray->axis != PatternAxis::columns || (gray->bit != one && gray->bit != other))
                return i;
            return placeOf(capture.order, GrayBit{gray->axis, gray->bit == one ? other : one, gray->inverse});
        });
}

/// Phase steps `step` and `step + 1` exchanged; of all sets, or of the finest of the columns alone.
void exchangeSteps(const CaptureOrder& order, Images& pose, int step, bool all) {
    int finest = 0;
    for (const PatternImage& image : order.images)
        if (const auto* phase = std::get_if<PhaseStep>(&image)) finest = std::max(finest, phase->periods);
    reorder(pose, [&](int i) {
        const auto* phase = std::get_if<PhaseStep>(&order.images[static_cast<std::size_t>(i)]);
        if (phase == nullptr || (!all && (phase->axis != PatternAxis::columns || phase->periods != finest))) return i;
        if (phase->step != step && phase->step != step + 1) return i;
        PhaseStep other = *phase;
        other.step = 2 * step + 1 - phase->step;
        return placeOf(order, other);
    });
}

/// A thing before the board: an ellipse of skin's grey that the projector lights as it lights the board.
cv::Mat covered(const cv::Mat& image, cv::Point2d at, double reach) {
    cv::Mat changed = image.clone();
    cv::Mat1b mask = cv::Mat1b::zeros(image.size());
    cv::ellipse(mask, {cv::Point2f(at), cv::Size2f(static_cast<float>(2.0 * reach), static_cast<float>(reach)), 35.0F},
                255, cv::FILLED);
    cv::Mat soft = blurred(image, 3.0);
    soft.convertTo(soft, CV_8U, 0.35, 12.0);
    soft.copyTo(changed, mask);
    return changed;
}

/// Where boards are: about the middle of what white lights most.
cv::Point2d middleOfLight(const SpoiledCapture& capture, std::size_t pose) {
    cv::Mat least = capture.poses[pose].front().clone();
    cv::Mat most = least.clone();
    for (const cv::Mat& image : capture.poses[pose]) {
        cv::min(least, image, least);
        cv::max(most, image, most);
    }
    const cv::Mat light = most - least;
    const cv::Moments moments = cv::moments(light > 0.5 * cv::mean(light)[0] + 20.0, true);
    return {moments.m10 / std::max(1.0, moments.m00), moments.m01 / std::max(1.0, moments.m00)};
}

cv::Mat withMoire(const cv::Mat& image, double strength, double period, double angle) {
    cv::Mat changed = image.clone();
    const double kx = 2.0 * std::numbers::pi * std::cos(angle) / period;
    const double ky = 2.0 * std::numbers::pi * std::sin(angle) / period;
    for (int y = 0; y < image.rows; ++y)
        for (int x = 0; x < image.cols; ++x)
            changed.at<uchar>(y, x) =
                cv::saturate_cast<uchar>(image.at<uchar>(y, x) * (1.0 + strength * std::sin(kx * x + ky * y)));
    return changed;
}

std::string text(double value) {
    std::string digits = std::to_string(value);
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.back() == '.') digits.pop_back();
    return digits;
}

class AccidentList {
public:
    void add(std::string name, std::vector<Cause> expected, std::function<void(SpoiledCapture&, std::mt19937&)> spoil,
             Patterns patterns = Patterns::any, bool mayPass = true) {
        const bool isAsked = name == "phase steps 2 and 3 exchanged, all sets"; // as if it hung upside down
        all_.push_back({std::move(name), std::move(expected), mayPass, patterns, std::move(spoil), isAsked});
    }

    void addSound() {
        add("sound", {}, [](SpoiledCapture&, std::mt19937&) {});
        add("half size", {}, [](SpoiledCapture& capture, std::mt19937&) {
            forAll(capture, [](const cv::Mat& image) {
                cv::Mat half;
                cv::resize(image, half, {}, 0.5, 0.5, cv::INTER_AREA);
                return half;
            });
        });
        for (const int quality : {95, 75})
            add("JPEG " + std::to_string(quality), {}, [quality](SpoiledCapture& capture, std::mt19937&) {
                forAll(capture, [quality](const cv::Mat& image) { return asJpeg(image, quality); });
            });
        for (const double gain : {0.6, 0.85})
            add("darker " + text(gain), {}, [gain](SpoiledCapture& capture, std::mt19937&) {
                forAll(capture, [gain](const cv::Mat& image) { return scaled(image, gain); });
            });
        add("poses in another order", {},
            [](SpoiledCapture& capture, std::mt19937&) { std::ranges::reverse(capture.poses); });
        add(
            "camera upside down", {},
            [](SpoiledCapture& capture, std::mt19937&) {
                forAll(capture, [](const cv::Mat& image) {
                    cv::Mat turned;
                    cv::rotate(image, turned, cv::ROTATE_180);
                    return turned;
                });
            },
            Patterns::gray);
        for (const double sigma : {2.0, 5.0})
            add("a little noise " + text(sigma), {}, [sigma](SpoiledCapture& capture, std::mt19937& dice) {
                forAll(capture, [&](const cv::Mat& image) { return withNoise(image, sigma, dice); });
            });
        add("a little blur", {}, [](SpoiledCapture& capture, std::mt19937&) {
            forAll(capture, [](const cv::Mat& image) { return blurred(image, 1.0); });
        });
    }

    void addMoved() {
        for (const double degrees : {0.1, 0.3, 0.6, 1.0, 3.0}) {
            const auto roll = [degrees](SpoiledCapture& capture, std::mt19937& dice, bool all) {
                const cv::Matx33d how = moved(capture.camera(), sign(dice) * degrees, {});
                const std::size_t from = 1 + dice() % (capture.poses.size() - 1);
                for (std::size_t v = from; v < (all ? capture.poses.size() : from + 1); ++v)
                    forPose(capture, v, [&](const cv::Mat& image) { return warped(image, how); });
                crop(capture);
            };
            add("camera rolled in one pose " + text(degrees), {Cause::cameraMoved},
                [roll](SpoiledCapture& capture, std::mt19937& dice) { roll(capture, dice, false); });
            add("camera rolled from a pose on " + text(degrees), {Cause::cameraMoved},
                [roll](SpoiledCapture& capture, std::mt19937& dice) { roll(capture, dice, true); });
        }
        for (const double pixels : {1.0, 2.0, 5.0, 10.0, 25.0})
            for (const bool all : {false, true})
                add(std::string(all ? "bump from a pose on " : "bump in one pose ") + text(pixels),
                    {Cause::cameraMoved}, [pixels, all](SpoiledCapture& capture, std::mt19937& dice) {
                        const double way = between(dice, 0.0, 2.0 * std::numbers::pi);
                        const cv::Matx33d how =
                            moved(capture.camera(), 0.0,
                                  {std::round(pixels * std::cos(way)), std::round(pixels * std::sin(way))});
                        const std::size_t from = 1 + dice() % (capture.poses.size() - 1);
                        for (std::size_t v = from; v < (all ? capture.poses.size() : from + 1); ++v)
                            forPose(capture, v, [&](const cv::Mat& image) { return warped(image, how); });
                        crop(capture);
                    });
        for (const double share : {1.02, 1.04})
            add("refocused from a pose on " + text(share), {Cause::cameraRefocused},
                [share](SpoiledCapture& capture, std::mt19937&) {
                    const cv::Matx33d how = moved(capture.camera(), 0.0, {}, share);
                    for (std::size_t v = capture.poses.size() / 2; v < capture.poses.size(); ++v)
                        forPose(capture, v, [&](const cv::Mat& image) { return warped(image, how); });
                });
        for (const double pixels : {2.0, 5.0, 9.0})
            add("moved within a pose " + text(pixels), {Cause::rigMoved},
                [pixels](SpoiledCapture& capture, std::mt19937& dice) {
                    Images& pose = capture.poses[anyPose(capture, dice)];
                    const cv::Matx33d how = moved(capture.camera(), 0.0, {sign(dice) * pixels, 0.0});
                    const auto count = static_cast<int>(pose.size());
                    for (int i = within(dice, count / 4, 3 * count / 4); i < count; ++i)
                        pose[static_cast<std::size_t>(i)] = warped(pose[static_cast<std::size_t>(i)], how);
                });
    }

    void addRepeated() {
        // The two poses that lie least tilted are not known here: any two.
        const auto twice = [](SpoiledCapture& capture, const std::function<cv::Mat(const cv::Mat&)>& change) {
            capture.poses = {capture.poses[0], capture.poses[0], capture.poses[1], capture.poses[1]};
            capture.names = {"a", "a again", "b", "b again"};
            forPose(capture, 1, change);
            forPose(capture, 3, change);
        };
        add(
            "two views, each twice", {Cause::repeatedPoses, Cause::tooFewViews},
            [=](SpoiledCapture& capture, std::mt19937&) { twice(capture, [](const cv::Mat& image) { return image; }); },
            Patterns::any, false);
        add(
            "two views, each re-saved", {Cause::repeatedPoses, Cause::tooFewViews},
            [=](SpoiledCapture& capture, std::mt19937&) {
                twice(capture, [](const cv::Mat& image) { return asJpeg(image, 92); });
            },
            Patterns::any, false);
        add(
            "two views, each photographed twice", {Cause::repeatedPoses, Cause::tooFewViews},
            [=](SpoiledCapture& capture, std::mt19937& dice) {
                twice(capture, [&](const cv::Mat& image) { return withNoise(image, 1.5, dice); });
            },
            Patterns::any, false);
        add(
            "one view twice", {Cause::repeatedPoses},
            [](SpoiledCapture& capture, std::mt19937& dice) {
                const std::size_t pose = anyPose(capture, dice);
                capture.poses.push_back(capture.poses[pose]);
                capture.names.emplace_back("again");
                forPose(capture, capture.poses.size() - 1,
                        [&](const cv::Mat& image) { return withNoise(image, 1.0, dice); });
            },
            Patterns::any, false);
    }

    void addSaid() {
        for (const auto& [dx, dy] : {std::pair(-24, 0), {-1, 0}, {0, -2}, {-2, -2}})
            add(
                "projector said " + std::to_string(dx) + " " + std::to_string(dy), {Cause::projectorSize},
                [dx, dy](SpoiledCapture& capture, std::mt19937&) { capture.order.projector += cv::Size(dx, dy); },
                Patterns::gray, false);
        add(
            "width and height exchanged", {Cause::widthHeightSwapped, Cause::projectorSize, Cause::wrongOrder},
            [](SpoiledCapture& capture, std::mt19937&) {
                std::swap(capture.order.projector.width, capture.order.projector.height);
            },
            Patterns::phase, false);
        for (const auto& [columns, rows] : {std::pair(7, 5), {8, 6}, {8, 7}, {10, 7}, {9, 8}})
            add(
                "board said " + std::to_string(columns) + "x" + std::to_string(rows), {Cause::boardSize},
                [columns, rows](SpoiledCapture& capture, std::mt19937&) {
                    capture.board.columns = columns;
                    capture.board.rows = rows;
                },
                Patterns::any, false);
        add(
            "squares of 1 um", {Cause::unlikelyLength},
            [](SpoiledCapture& capture, std::mt19937&) {
                capture.millimetresOfUnit = capture.board.spacing / 0.001;
                capture.board.spacing = 0.001;
            },
            Patterns::any, false);
        for (const int said : {8, 15, 17, 32})
            add(
                "periods said " + std::to_string(said), {Cause::periodCount},
                [said](SpoiledCapture& capture, std::mt19937&) {
                    for (PatternImage& image : capture.order.images)
                        if (auto* phase = std::get_if<PhaseStep>(&image); phase != nullptr && phase->periods > 1)
                            phase->periods = said;
                },
                Patterns::phase, false);
    }

    void addExposure() {
        for (const double step : {0.05, 0.15, 0.4})
            add("exposure steps by " + text(step), {Cause::exposureDrifts},
                [step](SpoiledCapture& capture, std::mt19937& dice) {
                    Images& pose = capture.poses[anyPose(capture, dice)];
                    const auto count = static_cast<int>(pose.size());
                    for (int i = within(dice, count / 4, 3 * count / 4); i < count; ++i)
                        pose[static_cast<std::size_t>(i)] = scaled(pose[static_cast<std::size_t>(i)], 1.0 - step);
                });
        for (const double rate : {0.003, 0.012, 0.02})
            add("exposure falls by " + text(rate) + " a picture", {Cause::exposureDrifts},
                [rate](SpoiledCapture& capture, std::mt19937&) {
                    for (Images& pose : capture.poses)
                        for (std::size_t i = 0; i < pose.size(); ++i)
                            pose[i] = scaled(pose[i], std::pow(1.0 - rate, static_cast<double>(i)));
                });
        for (const double amount : {0.1, 0.25})
            add("exposure by step " + text(amount), {Cause::exposureDrifts},
                [amount](SpoiledCapture& capture, std::mt19937&) {
                    for (Images& pose : capture.poses)
                        for (std::size_t i = 0; i < pose.size(); ++i)
                            pose[i] = scaled(pose[i], 1.0 - amount * 0.5 * static_cast<double>(i % 3));
                });
        add("exposure flickers", {Cause::exposureDrifts}, [](SpoiledCapture& capture, std::mt19937& dice) {
            for (Images& pose : capture.poses)
                for (cv::Mat& image : pose) image = scaled(image, between(dice, 0.75, 1.0));
        });
        // 30 may be read, 60 may not.
        for (const double sigma : {10.0, 20.0, 40.0, 60.0})
            add("noise " + text(sigma), {Cause::noisy}, [sigma](SpoiledCapture& capture, std::mt19937& dice) {
                forAll(capture, [&](const cv::Mat& image) { return withNoise(image, sigma, dice); });
            });
        for (const double power : {0.45, 1.8, 2.5, 3.5})
            add("gamma " + text(power), {Cause::projectorGamma}, [power](SpoiledCapture& capture, std::mt19937&) {
                forAll(capture, [power](const cv::Mat& image) { return raised(image, power); });
            });
        for (const double level : {30.0, 60.0})
            add("black cut at " + text(level), {Cause::clipped, Cause::underexposed},
                [level](SpoiledCapture& capture, std::mt19937&) {
                    forAll(capture, [level](const cv::Mat& image) {
                        return scaled(image, 255.0 / (255.0 - level), -level * 255.0 / (255.0 - level));
                    });
                });
        for (const double gain : {1.5, 2.5, 5.0})
            add("white cut, times " + text(gain), {Cause::clipped}, [gain](SpoiledCapture& capture, std::mt19937&) {
                forAll(capture, [gain](const cv::Mat& image) { return scaled(image, gain); });
            });
        for (const double gain : {0.03, 0.08})
            add("dark, times " + text(gain), {Cause::underexposed, Cause::noisy, Cause::boardUnlit},
                [gain](SpoiledCapture& capture, std::mt19937& dice) {
                    forAll(capture, [&](const cv::Mat& image) { return withNoise(scaled(image, gain), 1.0, dice); });
                });
        for (const double sigma : {3.0, 5.0, 8.0, 12.0})
            add("blur " + text(sigma), {Cause::outOfFocus}, [sigma](SpoiledCapture& capture, std::mt19937&) {
                forAll(capture, [sigma](const cv::Mat& image) { return blurred(image, sigma); });
            });
    }

    void addOrder() {
        add(
            "least significant bit first", {Cause::bitOrder},
            [](SpoiledCapture& capture, std::mt19937&) {
                for (Images& pose : capture.poses)
                    reorder(pose, [&](int i) {
                        const auto* gray = std::get_if<GrayBit>(&capture.order.images[static_cast<std::size_t>(i)]);
                        if (gray == nullptr) return i;
                        return placeOf(
                            capture.order,
                            GrayBit{gray->axis, bitsOf(capture.order, gray->axis) - 1 - gray->bit, gray->inverse});
                    });
            },
            Patterns::gray, false);
        for (const char* which : {"coarse", "middle", "fine", "far"})
            add(
                std::string("two bits exchanged, ") + which, {Cause::bitOrder},
                [which = std::string(which)](SpoiledCapture& capture, std::mt19937&) {
                    const int bits = bitsOf(capture.order, PatternAxis::columns);
                    if (which == "coarse") exchangeBits(capture, bits - 1, bits - 2);
                    if (which == "middle") exchangeBits(capture, bits / 2, bits / 2 + 1);
                    if (which == "fine") exchangeBits(capture, 0, 1);
                    if (which == "far") exchangeBits(capture, 1, bits - 2);
                },
                Patterns::gray, false);
        add(
            "rows before columns", {Cause::wrongOrder, Cause::projectorSize, Cause::widthHeightSwapped},
            [](SpoiledCapture& capture, std::mt19937&) {
                for (Images& pose : capture.poses) {
                    const int columns = 2 * bitsOf(capture.order, PatternAxis::columns);
                    std::rotate(pose.begin(), pose.begin() + columns, pose.end() - 2);
                }
            },
            Patterns::gray, false);
        add(
            "images in reverse", {Cause::wrongOrder, Cause::bitOrder, Cause::inverseSwapped, Cause::phaseOrder},
            [](SpoiledCapture& capture, std::mt19937&) {
                for (Images& pose : capture.poses) std::ranges::reverse(pose);
            },
            Patterns::any, false);
        add(
            "inverses first", {Cause::inverseSwapped},
            [](SpoiledCapture& capture, std::mt19937&) {
                for (Images& pose : capture.poses)
                    for (std::size_t i = 0; i + 3 < pose.size(); i += 2) std::swap(pose[i], pose[i + 1]);
            },
            Patterns::gray, false);
        add(
            "one pair exchanged", {Cause::inverseSwapped},
            [](SpoiledCapture& capture, std::mt19937& dice) {
                Images& pose = capture.poses[anyPose(capture, dice)];
                const std::size_t pair = 2 * (dice() % (pose.size() / 2 - 3));
                std::swap(pose[pair], pose[pair + 1]);
            },
            Patterns::gray);
        add(
            "white and black exchanged", {Cause::blackWhiteSwapped},
            [](SpoiledCapture& capture, std::mt19937& dice) {
                Images& pose = capture.poses[anyPose(capture, dice)];
                std::swap(pose[pose.size() - 2], pose[pose.size() - 1]);
            },
            Patterns::gray, false);
        for (const bool all : {true, false}) {
            add(
                std::string("phase steps 2 and 3 exchanged, ") + (all ? "all sets" : "finest columns"),
                {Cause::phaseOrder},
                [all](SpoiledCapture& capture, std::mt19937&) {
                    for (Images& pose : capture.poses) exchangeSteps(capture.order, pose, 1, all);
                },
                Patterns::phase, false);
            add(
                std::string("phase steps 1 and 2 exchanged, ") + (all ? "all sets" : "finest columns"),
                {Cause::phaseOrder},
                [all](SpoiledCapture& capture, std::mt19937&) {
                    for (Images& pose : capture.poses) exchangeSteps(capture.order, pose, 0, all);
                },
                Patterns::phase, false);
            add(
                std::string("phase steps exchanged in one pose, ") + (all ? "all sets" : "finest columns"),
                {Cause::phaseOrder},
                [all](SpoiledCapture& capture, std::mt19937& dice) {
                    exchangeSteps(capture.order, capture.poses[anyPose(capture, dice)], 1, all);
                },
                Patterns::phase, false);
        }
        add("one image late", {Cause::lateFrame, Cause::doubledImage}, [](SpoiledCapture& capture, std::mt19937& dice) {
            Images& pose = capture.poses[anyPose(capture, dice)];
            const std::size_t at = 1 + dice() % (pose.size() - 3);
            pose[at] = withNoise(pose[at - 1], 1.0, dice);
        });
        add(
            "late from an image on", {Cause::lateFrame, Cause::doubledImage},
            [](SpoiledCapture& capture, std::mt19937& dice) {
                Images& pose = capture.poses[anyPose(capture, dice)];
                const int from = within(dice, 1, static_cast<int>(pose.size()) / 2);
                const Images before = pose;
                for (std::size_t i = static_cast<std::size_t>(from); i < pose.size(); ++i)
                    pose[i] = withNoise(before[i - 1], 0.7, dice);
            },
            Patterns::any, false);
        add(
            "one image missing", {Cause::missingImage},
            [](SpoiledCapture& capture, std::mt19937& dice) {
                Images& pose = capture.poses[anyPose(capture, dice)];
                pose.erase(pose.begin() + within(dice, 1, static_cast<int>(pose.size()) - 3));
            },
            Patterns::any, false);
        add(
            "one image too many", {Cause::doubledImage},
            [](SpoiledCapture& capture, std::mt19937& dice) {
                Images& pose = capture.poses[anyPose(capture, dice)];
                const auto at = static_cast<std::size_t>(within(dice, 1, static_cast<int>(pose.size()) - 3));
                pose.insert(pose.begin() + static_cast<std::ptrdiff_t>(at), pose[at].clone());
            },
            Patterns::any, false);
        add(
            "one pose mirrored", {Cause::mirrored, Cause::phaseOrder},
            [](SpoiledCapture& capture, std::mt19937& dice) {
                forPose(capture, anyPose(capture, dice), [](const cv::Mat& image) {
                    cv::Mat flipped;
                    cv::flip(image, flipped, 1);
                    return flipped;
                });
            },
            Patterns::any, false);
        add(
            "all poses mirrored", {Cause::mirrored, Cause::phaseOrder},
            [](SpoiledCapture& capture, std::mt19937&) {
                forAll(capture, [](const cv::Mat& image) {
                    cv::Mat flipped;
                    cv::flip(image, flipped, 1);
                    return flipped;
                });
            },
            Patterns::any, false);
    }

    void addForeign() {
        for (const int pictures : {1, 3, 10})
            for (const double reach : {0.06, 0.14})
                add("hand in " + std::to_string(pictures) + " pictures, reach " + text(reach), {Cause::handInView},
                    [=](SpoiledCapture& capture, std::mt19937& dice) {
                        const std::size_t at = anyPose(capture, dice);
                        Images& pose = capture.poses[at];
                        const cv::Point2d middle = middleOfLight(capture, at) +
                                                   cv::Point2d(between(dice, -30.0, 30.0), between(dice, -30.0, 30.0));
                        const int from = within(dice, 1, std::max(1, static_cast<int>(pose.size()) - 4 - pictures));
                        for (int i = from; i < std::min(from + pictures, static_cast<int>(pose.size())); ++i)
                            pose[static_cast<std::size_t>(i)] =
                                covered(pose[static_cast<std::size_t>(i)], middle, reach * capture.camera().width);
                    });
        for (const double strength : {0.15, 0.3})
            add("moire in some pictures " + text(strength), {Cause::noisy, Cause::handInView},
                [strength](SpoiledCapture& capture, std::mt19937& dice) {
                    Images& pose = capture.poses[anyPose(capture, dice)];
                    const int from = within(dice, 2, static_cast<int>(pose.size()) / 2);
                    const double angle = between(dice, 0.0, std::numbers::pi);
                    for (int i = from; i < std::min(from + 6, static_cast<int>(pose.size())); ++i)
                        pose[static_cast<std::size_t>(i)] =
                            withMoire(pose[static_cast<std::size_t>(i)], strength, 9.0, angle);
                });
        const auto takeOther = [](SpoiledCapture& capture, std::mt19937& dice,
                                  const std::function<std::size_t(std::size_t)>& which) {
            const std::size_t pose = anyPose(capture, dice);
            const std::size_t other = (pose + 1 + dice() % (capture.poses.size() - 1)) % capture.poses.size();
            const std::size_t image = which(capture.poses[pose].size());
            capture.poses[pose][image] = capture.poses[other][image];
        };
        add(
            "white of another pose", {Cause::foreignImage},
            [=](SpoiledCapture& capture, std::mt19937& dice) {
                takeOther(capture, dice, [](std::size_t count) { return count - 2; });
            },
            Patterns::gray, false);
        add(
            "black of another pose", {Cause::foreignImage},
            [=](SpoiledCapture& capture, std::mt19937& dice) {
                takeOther(capture, dice, [](std::size_t count) { return count - 1; });
            },
            Patterns::gray);
        for (int k = 0; k < 3; ++k)
            add("a pattern of another pose " + std::to_string(k), {Cause::foreignImage},
                [=](SpoiledCapture& capture, std::mt19937& dice) {
                    takeOther(capture, dice, [&](std::size_t count) { return dice() % (count - 2); });
                });
        add("two images of another pose", {Cause::foreignImage}, [](SpoiledCapture& capture, std::mt19937& dice) {
            const std::size_t pose = anyPose(capture, dice);
            const std::size_t other = (pose + 1) % capture.poses.size();
            const std::size_t image = 2 * (dice() % (capture.poses[pose].size() / 2 - 2));
            for (const std::size_t i : {image, image + 1}) capture.poses[pose][i] = capture.poses[other][i];
        });
    }

    [[nodiscard]] std::vector<Accident> take() { return std::move(all_); }

private:
    std::vector<Accident> all_;
};

} // namespace

std::vector<Accident> accidents() {
    AccidentList list;
    list.addSound();
    list.addMoved();
    list.addRepeated();
    list.addSaid();
    list.addExposure();
    list.addOrder();
    list.addForeign();
    return list.take();
}

} // namespace lumorph::test
