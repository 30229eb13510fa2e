#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/motion/frequency_split.h"
#include "core/rig/rig_file.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/not_a_number.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

constexpr double kFrame = 1.0 / 60.0;

const Rig& tablet() {
    static const Rig rig = test::cutTablet();
    return rig;
}

/// How high a mesh is at a point: every triangle is looked at.
double topAt(const TriangleMesh& mesh, const glm::vec2& at, double nothing) {
    double top = -std::numeric_limits<double>::max();
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]);
        const glm::dvec3 b(mesh.positions[t.y]);
        const glm::dvec3 c(mesh.positions[t.z]);
        const double area = (b.x - a.x) * (c.z - a.z) - (c.x - a.x) * (b.z - a.z);
        if (std::abs(area) < 1e-16) continue;
        const double v = ((at.x - a.x) * (c.z - a.z) - (c.x - a.x) * (at.y - a.z)) / area;
        const double w = ((b.x - a.x) * (at.y - a.z) - (at.x - a.x) * (b.z - a.z)) / area;
        if (v >= -1e-7 && w >= -1e-7 && v + w <= 1.0 + 1e-7)
            top = std::max(top, a.y + v * (b.y - a.y) + w * (c.y - a.y));
    }
    return top > -1e9 ? top : nothing;
}

/// Bounded least squares by projected gradient, from several starts, on responses sampled finely and one actuator at a
/// time: what the rig can reach of heights over rest.
class Oracle {
public:
    Oracle(const Rig& rig, std::span<const glm::vec2> points) : count_(points.size()), actuators_(rig.actuatorCount()) {
        const double floor = static_cast<double>(boundingBox(rig.restMesh().positions).min.y);
        std::vector<double> rest;
        for (const glm::vec2& p : points) rest.push_back(topAt(rig.restMesh(), p, floor));
        for (std::size_t i = 0; i < actuators_; ++i)
            for (int k = 0; k <= kSteps; ++k) {
                std::vector<double> strokes(actuators_, 0.0);
                strokes[i] = static_cast<double>(k) / kSteps;
                const TriangleMesh mesh = deformed(rig, strokes);
                for (std::size_t p = 0; p < count_; ++p) curves_.push_back(topAt(mesh, points[p], floor) - rest[p]);
            }
    }

    struct Reach {
        double gain = 0.0;           ///< by how much the sum of squares can be made smaller
        std::vector<double> surface; ///< that does so, over rest
    };
    [[nodiscard]] Reach reach(const std::vector<double>& lifts) const {
        std::vector<double> best(actuators_, 0.0);
        const double whole = error(lifts, best, nullptr);
        for (const double start : {0.0, 0.1, 0.3, 0.6}) {
            const std::vector<double> found = descend(lifts, start);
            if (error(lifts, found, nullptr) < error(lifts, best, nullptr)) best = found;
        }
        Reach reach{whole - error(lifts, best, nullptr), std::vector<double>(count_, 0.0)};
        double slope = 0.0;
        for (std::size_t i = 0; i < actuators_; ++i)
            for (std::size_t p = 0; p < count_; ++p) reach.surface[p] += curve(i, best[i], p, slope);
        return reach;
    }

private:
    static constexpr int kSteps = 80;

    [[nodiscard]] double curve(std::size_t i, double stroke, std::size_t p, double& slope) const {
        const double at = stroke * kSteps;
        const auto k = static_cast<std::size_t>(std::min(at, kSteps - 1.0));
        const std::size_t row = (i * (kSteps + 1) + k) * count_ + p;
        slope = (curves_[row + count_] - curves_[row]) * kSteps;
        return curves_[row] + (at - static_cast<double>(k)) * (curves_[row + count_] - curves_[row]);
    }
    double error(const std::vector<double>& lifts, const std::vector<double>& s, std::vector<double>* gradient) const {
        std::vector<double> left = lifts;
        double slope = 0.0;
        for (std::size_t i = 0; i < actuators_; ++i)
            for (std::size_t p = 0; p < count_; ++p) left[p] -= curve(i, s[i], p, slope);
        double sum = 0.0;
        for (const double l : left) sum += l * l;
        if (gradient)
            for (std::size_t i = 0; i < actuators_; ++i) {
                (*gradient)[i] = 0.0;
                for (std::size_t p = 0; p < count_; ++p) {
                    (void)curve(i, s[i], p, slope);
                    (*gradient)[i] -= 2.0 * left[p] * slope;
                }
            }
        return sum;
    }
    [[nodiscard]] std::vector<double> descend(const std::vector<double>& lifts, double start) const {
        std::vector<double> s(actuators_, start);
        std::vector<double> gradient(actuators_);
        double step = 10.0;
        double now = error(lifts, s, &gradient);
        for (int k = 0; k < 150 && step > 1e-9; ++k) {
            std::vector<double> next = s;
            for (std::size_t i = 0; i < actuators_; ++i) next[i] = std::clamp(s[i] - step * gradient[i], 0.0, 1.0);
            const double then = error(lifts, next, nullptr);
            if (then < now) {
                s = next;
                now = error(lifts, s, &gradient);
                step *= 1.5;
            } else {
                step *= 0.4;
            }
        }
        return s;
    }

    std::size_t count_;
    std::size_t actuators_;
    std::vector<double> curves_;
};

struct Travelling {
    double amplitude, length, period, across;
    [[nodiscard]] double at(const glm::vec2& p, double t) const {
        const double along = static_cast<double>(p.x) + across * static_cast<double>(p.y);
        return amplitude * std::sin(2.0 * std::numbers::pi * (along / length - t / period));
    }
};

using Waves = std::vector<Travelling>;

FrequencySplit::Wish wishOf(const FrequencySplit& split, const Waves& waves) {
    return [&split, waves](double t, std::span<float> heights) {
        for (std::size_t p = 0; p < heights.size(); ++p) {
            double height = static_cast<double>(split.restHeights()[p]);
            for (const Travelling& wave : waves) height += wave.at(split.points()[p], t);
            heights[p] = static_cast<float>(height);
        }
    };
}

using Surfaces = std::vector<std::vector<double>>; // over rest, one a moment

/// Sums of squares over a run.
struct Energies {
    double carried = 0.0;   ///< of the judged wave, what the surface takes away
    double reachable = 0.0; ///< the oracle's
    double motion = 0.0;    ///< of the surface around its mean over time
    double best = 0.0;      ///< the same of the oracle's
    Surfaces surfaces;
};

double motionOf(const Surfaces& surfaces) {
    double motion = 0.0;
    for (std::size_t p = 0; p < surfaces.front().size(); ++p) {
        double mean = 0.0;
        for (const auto& surface : surfaces) mean += surface[p] / static_cast<double>(surfaces.size());
        for (const auto& surface : surfaces) motion += (surface[p] - mean) * (surface[p] - mean);
    }
    return motion;
}

/// What is left of one run where the other is taken away, a moment.
double differenceOf(const Surfaces& one, const Surfaces& other) {
    double sum = 0.0;
    for (std::size_t k = 0; k < one.size(); ++k)
        for (std::size_t p = 0; p < one[k].size(); ++p) sum += std::pow(one[k][p] - other.at(k)[p], 2.0);
    return sum / static_cast<double>(one.size());
}

/// Commands strokes for `wished`; from second 2 on the surface six times a second, with its time.
template <class Judge> void command(FrequencySplit& split, const Waves& wished, double seconds, const Judge& judge) {
    const std::size_t count = split.points().size();
    std::vector<float> reached(count);
    std::vector<double> surface(count);
    for (int k = 0; k < static_cast<int>(seconds * 30.0); ++k) {
        const double t = k / 30.0;
        const std::vector<double> strokes = split.strokes(wishOf(split, wished), t);
        if (t < 2.0 || k % 5 != 0) continue;
        split.heights(strokes, reached);
        for (std::size_t p = 0; p < count; ++p)
            surface[p] = static_cast<double>(reached[p]) - static_cast<double>(split.restHeights()[p]);
        judge(t, surface);
    }
}

/// Judges against `judged` alone what `wished` gives.
Energies runOf(FrequencySplit& split, const Oracle& oracle, const Waves& wished, const Waves& judged, double seconds) {
    Energies run;
    Surfaces best;
    command(split, wished, seconds, [&](double t, const std::vector<double>& surface) {
        std::vector<double> lifts(surface.size());
        for (std::size_t p = 0; p < lifts.size(); ++p) {
            for (const Travelling& wave : judged) lifts[p] += wave.at(split.points()[p], t);
            run.carried += lifts[p] * lifts[p] - (lifts[p] - surface[p]) * (lifts[p] - surface[p]);
        }
        Oracle::Reach reach = oracle.reach(lifts);
        run.reachable += reach.gain;
        best.push_back(std::move(reach.surface));
        run.surfaces.push_back(surface);
    });
    run.motion = motionOf(run.surfaces);
    run.best = motionOf(best);
    return run;
}

struct Device {
    const char* name;
    Rig rig;
    double spacing;
};

std::vector<Device> devices() {
    return {{"tablet", tablet(), 0.012}, {"cushion", test::cushionRig(), 0.006}, {"lifter", test::lifterRig(), 0.006}};
}

// R33, Fig. 2
TEST(FrequencySplit, ServosCarryTheSlowAndLongAndLeaveTheFastAndShort) {
    for (const Device& device : devices()) {
        FrequencySplit split(device.rig, device.spacing);
        const Oracle oracle(device.rig, split.points());
        const Travelling slow{0.012, 0.3, 8.0, 0.4};
        const Travelling fast{0.004, 0.03, 0.35, -0.7};
        const Energies both = runOf(split, oracle, {slow, fast}, {slow}, 18.0);
        EXPECT_GE(both.carried, 0.9 * both.reachable) << device.name;
        EXPECT_GT(both.reachable, 0.0);
        // The oracle adds up what overlapping boxes do, which is more than they can.
        if (device.name != std::string("lifter")) {
            EXPECT_GE(both.motion, 0.9 * both.best) << device.name;
        }
        RecordProperty(std::string(device.name) + "_slow_permille",
                       static_cast<int>(std::lround(1000.0 * both.carried / both.reachable)));
        split.restart();
        const Energies flutter = runOf(split, oracle, {fast}, {fast}, 6.0);
        EXPECT_LE(flutter.motion, 0.05 * flutter.reachable) << device.name;
        EXPECT_GT(flutter.reachable, 0.0) << device.name;
        // Nor do they follow it while they carry the slow.
        split.restart();
        Surfaces slowAlone;
        command(split, {slow}, 18.0, [&](double, const auto& surface) { slowAlone.push_back(surface); });
        const double reachable = flutter.reachable / static_cast<double>(flutter.surfaces.size());
        EXPECT_LE(differenceOf(both.surfaces, slowAlone), 0.05 * reachable) << device.name;
        RecordProperty(std::string(device.name) + "_fast_in_the_mix_permille",
                       static_cast<int>(std::lround(1000.0 * differenceOf(both.surfaces, slowAlone) / reachable)));
        RecordProperty(std::string(device.name) + "_fast_permille",
                       static_cast<int>(std::lround(1000.0 * flutter.motion / flutter.reachable)));
        // A long wave that is fast stays light's too.
        split.restart();
        const Travelling swift{0.012, 0.3, 0.4, 0.4};
        const Energies rush = runOf(split, oracle, {swift}, {swift}, 6.0);
        EXPECT_LE(rush.motion, 0.05 * rush.reachable) << device.name;
    }
}

TEST(FrequencySplit, HeightsAreThoseOfTheDeformedDevice) {
    for (const Device& device : devices()) {
        const FrequencySplit split(device.rig, device.spacing);
        ASSERT_GT(split.points().size(), 100U);
        std::mt19937 random(3);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        std::vector<float> heights(split.points().size());
        for (int k = 0; k < 4; ++k) {
            std::vector<double> strokes(device.rig.actuatorCount(), 0.0);
            if (k > 0)
                for (double& stroke : strokes) stroke = uniform(random);
            split.heights(strokes, heights);
            const TriangleMesh mesh = deformed(device.rig, strokes);
            for (std::size_t p = 0; p < heights.size(); ++p) {
                EXPECT_NEAR(heights[p], topAt(mesh, split.points()[p], 0.0), 2e-5) << device.name << ' ' << p;
                if (k == 0) {
                    EXPECT_NEAR(heights[p], split.restHeights()[p], 1e-6);
                }
            }
        }
    }
}

TEST(FrequencySplit, FitFindsStrokesThatMadeTheHeights) {
    for (const Device& device : {Device{"tablet", tablet(), 0.006}, Device{"cushion", test::cushionRig(), 0.006}}) {
        FrequencySplit split(device.rig, device.spacing);
        std::vector<float> heights(split.points().size());
        std::mt19937 random(8);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        for (int k = 0; k < 20; ++k) {
            std::vector<double> strokes(device.rig.actuatorCount());
            for (double& stroke : strokes) stroke = uniform(random);
            split.heights(strokes, heights);
            const std::vector<double> found = split.fit(heights);
            for (std::size_t i = 0; i < strokes.size(); ++i)
                EXPECT_NEAR(found[i], strokes[i], 0.02) << device.name << ' ' << i;
        }
    }
}

/// Joints in a row: what each does depends on the others, and the surface draws back from where it was.
TEST(FrequencySplit, FitSeesWhatJointsDoTogether) {
    const Rig ribbon = readRig(LUMORPH_SOURCE_DIR "/resources/models/ribbon.glb");
    for (const Device& device : {Device{"arm", test::armRig(), 0.005}, Device{"ribbon", ribbon, 0.006},
                                 Device{"lifter", test::lifterRig(), 0.006}}) {
        FrequencySplit split(device.rig, device.spacing);
        std::vector<float> wanted(split.points().size());
        std::vector<float> found(split.points().size());
        std::mt19937 random(1);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        double whole = 0.0;
        double left = 0.0;
        for (int k = 0; k < 20; ++k) {
            std::vector<double> strokes(device.rig.actuatorCount());
            for (double& stroke : strokes) stroke = uniform(random);
            split.heights(strokes, wanted);
            split.heights(split.fit(wanted), found);
            for (std::size_t p = 0; p < wanted.size(); ++p) {
                const auto square = [](float x) { return static_cast<double>(x) * static_cast<double>(x); };
                whole += square(wanted[p] - split.restHeights()[p]);
                left += square(wanted[p] - found[p]);
            }
        }
        EXPECT_LE(left, 0.05 * whole) << device.name;
    }
}

TEST(FrequencySplit, WhatLiesBelowRestIsLeftToLight) {
    FrequencySplit split(tablet(), 0.01);
    std::vector<float> low(split.restHeights().begin(), split.restHeights().end());
    EXPECT_EQ(split.fit(low), std::vector<double>(6, 0.0));
    for (float& height : low) height -= 0.01F;
    EXPECT_EQ(split.fit(low), std::vector<double>(6, 0.0));
}

// R19
TEST(FrequencySplit, CommandsNeverMoveFasterThanTheLimits) {
    struct Course {
        Device device;
        int steps;
    };
    for (const Course& course :
         {Course{{"tablet", tablet(), 0.03}, 95'000}, Course{{"arm", test::armRig(), 0.005}, 5'000}}) {
        const Device& device = course.device;
        FrequencySplit split(device.rig, device.spacing);
        std::mt19937 random(21);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        float wild = 0.0F;
        const FrequencySplit::Wish wish = [&](double t, std::span<float> heights) {
            for (std::size_t p = 0; p < heights.size(); ++p) {
                switch ((p + static_cast<std::size_t>(wild * 7.0F)) % 5) {
                case 0:
                    heights[p] = wild;
                    break;
                case 1:
                    heights[p] = std::numeric_limits<float>::quiet_NaN();
                    break;
                case 2:
                    heights[p] = std::sin(t) > 0.0 ? HUGE_VALF : -HUGE_VALF;
                    break;
                default:
                    heights[p] += wild * static_cast<float>(std::sin(t));
                    break;
                }
            }
        };
        double t = 0.0;
        double most = 0.0;
        std::vector<double> last = split.strokes(wish, t);
        for (int k = 0; k < course.steps; ++k) {
            if (random() % 40 == 0) wild = static_cast<float>(uniform(random) - 0.3);
            const double step = random() % 10 == 0 ? 0.0 : 0.1 * uniform(random) * uniform(random);
            t += step;
            const std::vector<double> now = split.strokes(wish, t);
            for (std::size_t i = 0; i < now.size(); ++i) {
                ASSERT_TRUE(now[i] >= 0.0 && now[i] <= 1.0);
                const double limit = device.rig.actuators()[i].maxVelocity * step;
                ASSERT_LE(std::abs(now[i] - last[i]), limit + 1e-12) << device.name << ' ' << k;
                most = std::max(most, std::abs(now[i] - last[i]) / std::max(limit, 1e-9));
            }
            last = now;
        }
        EXPECT_GT(most, 0.999) << "the limit was met";
    }
}

TEST(FrequencySplit, TimeThatRunsBackBeginsAnew) {
    FrequencySplit split(tablet(), 0.02);
    bool high = false;
    const FrequencySplit::Wish wish = [&](double, std::span<float> heights) {
        for (float& height : heights) height += high ? 0.04F : 0.0F;
    };
    EXPECT_EQ(split.strokes(wish, 10.0), std::vector<double>(6, 0.0));
    high = true;
    const std::vector<double> soon = split.strokes(wish, 10.0 + kFrame);
    const std::vector<double> anew = split.strokes(wish, 5.0);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_LE(soon[i], 1.34 * kFrame);
        EXPECT_GT(anew[i], 0.2);
    }
    for (const double wrong : {kNan, HUGE_VAL, 1e300}) EXPECT_THROW((void)split.strokes(wish, wrong), InvalidInput);
    EXPECT_EQ(split.strokes(wish, 5.0), anew);
}

/// A show that stands at one moment while its scene is edited: no time has passed in which a servo could move.
TEST(FrequencySplit, TheSameTimeAgainMovesNothing) {
    FrequencySplit split(tablet());
    const auto flat = [](double, std::span<float>) {};
    const auto high = [](double, std::span<float> heights) {
        for (float& height : heights) height += 0.05F;
    };
    const std::vector<double> before = split.strokes(flat, 3.0);
    EXPECT_EQ(split.strokes(high, 3.0), before);
    const std::vector<double> after = split.strokes(high, 3.1);
    EXPECT_NE(after, before);
    for (std::size_t i = 0; i < after.size(); ++i)
        EXPECT_LE(std::abs(after[i] - before[i]), tablet().actuators()[i].maxVelocity * 0.1 + 1e-9);
}

TEST(FrequencySplit, HeightsThatAreNoNumbersCountAsRest) {
    FrequencySplit split(tablet(), 0.01);
    const FrequencySplit::Wish nothing = [](double, std::span<float> heights) {
        std::ranges::fill(heights, std::numeric_limits<float>::quiet_NaN());
    };
    EXPECT_EQ(split.strokes(nothing, 0.0), std::vector<double>(6, 0.0));
    std::vector<float> one(split.restHeights().begin(), split.restHeights().end());
    EXPECT_THROW((void)split.fit(std::span(one).first(3)), InvalidInput);
    for (const double wrong : {0.0, -1.0, kNan}) EXPECT_THROW(FrequencySplit(tablet(), wrong), InvalidInput);
}

TEST(FrequencySplit, AsksForTheWishAtWholeStepsOnly) {
    FrequencySplit split(tablet(), 0.02);
    std::vector<double> times;
    const FrequencySplit::Wish wish = [&](double t, std::span<float>) { times.push_back(t); };
    for (int k = 0; k < 60; ++k) (void)split.strokes(wish, 3.0 + k * kFrame);
    std::ranges::sort(times);
    times.erase(std::unique(times.begin(), times.end()), times.end());
    EXPECT_LT(times.size(), 60U) << "so that what was worked out can be kept";
}

} // namespace
} // namespace lumorph
