#include "core/render/spatial_renderer.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "calibration/lab/lab_world.h"
#include "core/base/error.h"
#include "core/loop/hand_near.h"
#include "core/render/gl/headless_context.h"
#include "tests/calibration/show_world.h"

namespace lumorph {
namespace {

const CalibratedCamera kAbove = cameraLookingAt({0.02, 1.1, 0.25}, {0.0, 0.0, 0.0}, {360, 260}, 620.0);
constexpr double kSteepest = 65.0 * 3.14159265358979 / 180.0;

// Two projectors from left and right that both hold the device, with borders in the other's image.
std::vector<InstalledProjector> pair() {
    return {projectorAt({-0.7, 1.4, 0.1}, {-0.06, 0.0, 0.0}, {640, 400}, 1700.0),
            projectorAt({0.75, 1.3, -0.1}, {0.07, 0.0, 0.02}, {600, 420}, 1600.0)};
}

// Whether the surface is smooth for three pixels around: at creases and rims light of one face spills onto the other.
bool smoothAround(const Lab& lab, const glm::dvec2& pixel, const Lab::Hit& hit) {
    for (int k = 0; k < 9; ++k) {
        const glm::dvec2 beside = pixel + 3.0 * glm::dvec2(k % 3 - 1, k / 3 - 1);
        const auto other = lab.trace(positionOf(kAbove), directionOf(kAbove, beside));
        if (!other || glm::dot(other->normal, hit.normal) < 0.97) return false;
        if (std::abs(glm::dot(other->point - hit.point, hit.normal)) > 0.0015) return false;
    }
    return true;
}

// What a point of the lab looks like to its projectors.
enum class Reach { none, some, edge };

// The nine points around one, `aside` metres away, that a projector lights.
int litAround(const Lab& lab, std::size_t projector, const Lab::Hit& hit, double aside) {
    const glm::dvec3 helper = std::abs(hit.normal.y) > 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(hit.normal, helper));
    const glm::dvec3 along = glm::cross(hit.normal, across);
    int lit = 0;
    for (int k = 0; k < 9; ++k)
        lit +=
            lab.lit(projector, hit.point + aside * (double(k % 3 - 1) * across + double(k / 3 - 1) * along), hit.normal)
                ? 1
                : 0;
    return lit;
}

// `edge`: no projector reaches it for sure and not too steeply, or the edge of a shadow is so near that the pixels
// blur it.
Reach reachOf(const Lab& lab, const std::vector<InstalledProjector>& projectors, const Lab::Hit& hit) {
    constexpr double kPixel = 0.0011; // and a bit: 1.5 m at 1600 pixels
    bool sure = false;
    bool ever = false;
    for (std::size_t i = 0; i < projectors.size(); ++i) {
        const glm::dvec3 way = glm::normalize(positionOf(projectors[i].camera) - hit.point);
        const int near = litAround(lab, i, hit, kPixel);
        if (near > 0 && near < 9) return Reach::edge;
        const bool steep = glm::dot(way, hit.normal) < std::cos(kSteepest);
        sure = sure || (!steep && near == 9 && litAround(lab, i, hit, 2.5 * kPixel) == 9);
        ever = ever || litAround(lab, i, hit, 2.5 * kPixel) > 0;
    }
    return sure ? Reach::some : ever ? Reach::edge : Reach::none;
}

/// Whether something stands in a projector's way to a place that it would light else.
bool inShadow(const Lab& lab, const std::vector<InstalledProjector>& projectors, const Lab::Hit& hit) {
    for (std::size_t i = 0; i < projectors.size(); ++i) {
        const CalibratedCamera& camera = projectors[i].camera;
        const auto pixel = pixelOf(camera, hit.point);
        if (!pixel || pixel->x < 0.0 || pixel->y < 0.0 || pixel->x > camera.size.x - 1.0 ||
            pixel->y > camera.size.y - 1.0)
            continue;
        if (glm::dot(positionOf(camera) - hit.point, hit.normal) > 0.0 && !lab.lit(i, hit.point, hit.normal))
            return true;
    }
    return false;
}

struct Flatness {
    int judged = 0;
    int worse = 0;    // than 3 %
    int shadowed = 0; // of the judged, where one projector's light is in shadow
    int shadowedWorse = 0;
    double worst = 0.0;
    int dark = 0; // unreached places that are dark
    int unreached = 0;
};

Flatness flatnessOf(const Lab& lab, const std::vector<InstalledProjector>& projectors, double expected) {
    Flatness result;
    const std::vector<glm::vec3> seen = lab.radiance(kAbove, 1);
    for (int y = 0; y < kAbove.size.y; ++y)
        for (int x = 0; x < kAbove.size.x; ++x) {
            const auto hit = lab.trace(positionOf(kAbove), directionOf(kAbove, {x, y}));
            if (!hit || !smoothAround(lab, {x, y}, *hit)) continue;
            const float value = seen[static_cast<std::size_t>(y * kAbove.size.x + x)].g;
            switch (reachOf(lab, projectors, *hit)) {
            case Reach::none:
                ++result.unreached;
                result.dark += value == 0.0F ? 1 : 0;
                break;
            case Reach::edge:
                break;
            case Reach::some: {
                const double error = std::abs(double(value) / expected - 1.0);
                ++result.judged;
                result.worse += error > 0.03 ? 1 : 0;
                result.worst = std::max(result.worst, error);
                if (!inShadow(lab, projectors, *hit)) break;
                ++result.shadowed;
                result.shadowedWorse += error > 0.03 ? 1 : 0;
            }
            }
        }
    return result;
}

double linear(double value) { return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4); }

TEST(SpatialRendererInRoom, OneProjectorMakesABentDeviceUniform) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    const std::vector<InstalledProjector> projectors{pair()[0]};
    const ShowFrame frame = frameOf(unlitScene(glm::vec3(0.7F), glm::vec3(0.7F), projectors), liftedFlaps());
    renderer.draw(frame);
    const Lab lab(labOf(frame, renderer));
    const Flatness flat = flatnessOf(lab, projectors, linear(0.7));
    EXPECT_GT(flat.judged, 20'000);
    EXPECT_LE(flat.worse, flat.judged / 500) << flat.worst;
    EXPECT_EQ(flat.dark, flat.unreached);
    EXPECT_GT(flat.unreached, 1000);
}

TEST(SpatialRendererInRoom, WithoutCompensationTheValueIsTheContent) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    SceneInRoom scene = unlitScene(glm::vec3(0.7F), glm::vec3(0.7F), {pair()[0]});
    scene.compensation = false;
    const ShowFrame frame = frameOf(scene, liftedFlaps());
    renderer.draw(frame);
    const Image sent = renderer.readProjector(0);
    const double value = linear(0.7) / scene.projectors[0].peak;
    for (const glm::ivec2& at : {glm::ivec2(320, 200), glm::ivec2(40, 60), glm::ivec2(600, 380)})
        EXPECT_NEAR(linear(sent.at(at.x, at.y)[1] / 255.0), value, 0.004);
}

TEST(SpatialRendererInRoom, TwoProjectorsShareTheWorkWithoutASeam) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    const std::vector<InstalledProjector> projectors = pair();
    const ShowFrame frame = frameOf(unlitScene(glm::vec3(0.7F), glm::vec3(0.7F), projectors), liftedFlaps());
    renderer.draw(frame);
    const Lab lab(labOf(frame, renderer));
    const Flatness flat = flatnessOf(lab, projectors, linear(0.7));
    EXPECT_GT(flat.judged, 25'000);
    EXPECT_LE(flat.worse, flat.judged / 500) << flat.worst;
    EXPECT_EQ(flat.dark, flat.unreached);
    RecordProperty("shadowed", flat.shadowed);
    EXPECT_GT(flat.shadowed, 400) << "a lifted flap stands in one projector's light";
    EXPECT_LE(flat.shadowedWorse, flat.shadowed / 100);

    // Both really work where both reach: neither does it alone.
    const Image first = renderer.readProjector(0);
    const auto pixel = pixelOf(projectors[0].camera, {0.0, 0.0, 0.16});
    ASSERT_TRUE(pixel);
    const double value = linear(first.at(int(pixel->x), int(pixel->y))[1] / 255.0);
    SceneInRoom alone{*frame.scene, *frame.installation};
    alone.projectors[1].enabled = false;
    renderer.draw(frameOf(alone, liftedFlaps()));
    const double whole = linear(renderer.readProjector(0).at(int(pixel->x), int(pixel->y))[1] / 255.0);
    EXPECT_GT(value, 0.2 * whole);
    EXPECT_LT(value, 0.8 * whole);
    EXPECT_EQ(renderer.projectorTexture(1), 0U);
}

// Of the device's places that are seen beside a visitor's hand, the share from which his hand takes more than 30 % of
// their light, by rays.
double shadowedByHand(SpatialRenderer& renderer, const std::vector<InstalledProjector>& projectors, bool tracked) {
    const glm::vec3 place(0.0F, 0.12F, 0.02F);
    ShowFrame frame = frameOf(unlitScene(glm::vec3(0.6F), glm::vec3(0.6F), projectors), liftedFlaps());
    renderer.draw(frame);
    const std::vector<glm::vec3> free = Lab(labOf(frame, renderer)).radiance(kAbove, 1);
    if (tracked) frame.hands = handAt(place, frame.eye);
    renderer.draw(frame);
    LabWorld world = labOf(frame, renderer);
    world.blockers.push_back(visitorHand(place, *frame.eye));
    const Lab lab(std::move(world));
    const std::vector<glm::vec3> held = lab.radiance(kAbove, 1);
    double lit = 0.0, lost = 0.0;
    for (int y = 0; y < kAbove.size.y; ++y)
        for (int x = 0; x < kAbove.size.x; ++x) {
            const auto hit = lab.trace(positionOf(kAbove), directionOf(kAbove, {x, y}));
            const auto k = static_cast<std::size_t>(y * kAbove.size.x + x);
            if (!hit || hit->surface != 0 || hit->normal.y < 0.5 || free[k].g < 0.1F) continue;
            lit += 1.0;
            lost += held[k].g < 0.7F * free[k].g ? 1.0 : 0.0;
        }
    return lost / lit;
}

TEST(SpatialRendererInRoom, ShadowOfATrackedHandIsFilledByTheOtherProjector) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    const double one =
        std::max(shadowedByHand(renderer, {pair()[0]}, true), shadowedByHand(renderer, {pair()[1]}, true));
    const double unknown = shadowedByHand(renderer, pair(), false);
    const double two = shadowedByHand(renderer, pair(), true);
    for (const auto& [name, share] : {std::pair("one", one), {"two_unknown", unknown}, {"two", two}})
        RecordProperty(name, std::to_string(100.0 * share));
    EXPECT_GT(one, 0.1);
    EXPECT_GT(unknown, 2.0 * two) << "where nobody tracks it";
    EXPECT_LE(two, 0.2 * one) << "of the top; one projector alone leaves " << one;
}

// The share of the light at a table's point that a projector brings, from the value it sends there.
double shareOf(const InstalledProjector& projector, const Image& sent, glm::ivec2 pixel, const glm::dvec3& point) {
    const glm::dvec3 way = positionOf(projector.camera) - point;
    const double distance = glm::length(way);
    const double full = projector.peak * way.y / distance * std::pow(projector.referenceDistance / distance, 2.0);
    return linear(sent.at(pixel.x, pixel.y)[1] / 255.0) * full / linear(0.7);
}

// Whether a projector sees nothing but table far around a point, so that it could do all the work there.
bool seesOpenTable(const Lab& lab, const CalibratedCamera& camera, const glm::dvec3& point) {
    const auto pixel = pixelOf(camera, point);
    const glm::dvec2 room = glm::dvec2(camera.size) - 34.0;
    if (!pixel || pixel->x < 33.0 || pixel->y < 33.0 || pixel->x > room.x || pixel->y > room.y) return false;
    for (int k = 0; k < 24; ++k) {
        const double turn = 0.25 * 3.14159265 * k;
        const double radius = 15.0 * (1 + k / 8);
        const auto hit = lab.trace(positionOf(camera),
                                   directionOf(camera, *pixel + radius * glm::dvec2(std::cos(turn), std::sin(turn))));
        if (!hit || hit->surface != 1) return false;
    }
    return true;
}

TEST(SpatialRendererInRoom, WeightsFallSmoothlyTowardsShadowsAndBorders) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    const std::vector<InstalledProjector> projectors = pair();
    SceneInRoom scene = unlitScene(glm::vec3(0.7F), glm::vec3(0.7F), projectors);
    scene.worldFromDevice[3].y = 0.12F; // held up, so that its shadows lie apart
    const ShowFrame frame = frameOf(scene, liftedFlaps());
    renderer.draw(frame);
    const Lab lab(labOf(frame, renderer));
    const CalibratedCamera& camera = projectors[0].camera;
    const Image sent = renderer.readProjector(0);
    const glm::dvec3 up(0.0, 1.0, 0.0);
    int shared = 0;
    int atShadows = 0;
    int atBorders = 0;
    double before = -1.0; // the share of the pixel to the left
    for (int y = 0; y < camera.size.y; y += 4)
        for (int x = 0; x < camera.size.x; ++x) {
            const auto hit = lab.trace(positionOf(camera), directionOf(camera, {x, y}));
            const bool both = hit && hit->surface == 1 && lab.lit(1, hit->point, up) &&
                              seesOpenTable(lab, projectors[1].camera, hit->point);
            if (!both || x == 0) before = -1.0;
            if (!both) continue;
            const double share = shareOf(projectors[0], sent, {x, y}, hit->point);
            if (share > 0.1 && share < 0.9) ++shared;
            if (before >= 0.0) {
                // A pixel on two surfaces has a value between theirs, so its share is not that of the point alone.
                EXPECT_LT(std::abs(share - before), 0.15) << x << ", " << y;
            }
            before = share;
            const auto beside = lab.trace(positionOf(camera), directionOf(camera, {x - 1, y}));
            if (beside && beside->surface == 0 &&
                lab.trace(positionOf(camera), directionOf(camera, {x - 4, y}))->surface == 0) {
                EXPECT_LT(share, 0.15) << "beside the device at " << x << ", " << y;
                ++atShadows;
            }
            if (x != 1 && x != camera.size.x - 2) continue;
            EXPECT_LT(share, 0.1) << "at the border, row " << y;
            ++atBorders;
        }
    EXPECT_GT(shared, 10'000);
    EXPECT_GT(atShadows, 5);
    EXPECT_GT(atBorders, 20);
}

TEST(SpatialRendererInRoom, GammaOfAProjectorIsAnswered) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    std::vector<InstalledProjector> projectors{pair()[0]};
    projectors[0].gamma = 2.6;
    const ShowFrame frame = frameOf(unlitScene(glm::vec3(0.7F), glm::vec3(0.7F), projectors), liftedFlaps());
    renderer.draw(frame);
    const Lab lab(labOf(frame, renderer));
    const Flatness flat = flatnessOf(lab, projectors, linear(0.7));
    EXPECT_GT(flat.judged, 20'000);
    EXPECT_LE(flat.worse, flat.judged / 500) << flat.worst;
}

// How different two pictures are on average, and at how many pixels they differ much.
struct Difference {
    double mean = 0.0;
    double muchShare = 0.0;
};

Difference between(const Image& first, const Image& second) {
    Difference difference;
    for (std::size_t i = 0; i < first.pixels().size(); ++i) {
        double step = 0.0; // of the channel that differs most
        for (std::size_t c = 0; c < 3; ++c)
            step = std::max<double>(step, std::abs(first.pixels()[i][c] - second.pixels()[i][c]));
        difference.mean += step / static_cast<double>(first.pixels().size());
        difference.muchShare += (step > 20 ? 1.0 : 0.0) / static_cast<double>(first.pixels().size());
    }
    return difference;
}

TEST(SpatialRendererInRoom, PreviewOfTheLabShowsWhatTheLabShows) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    std::vector<InstalledProjector> projectors = pair();
    projectors[1].gamma = 1.8;
    projectors[0].gain = {0.8F, 0.9F, 0.7F};
    SceneInRoom scene = unlitScene({0.9F, 0.5F, 0.2F}, {0.1F, 0.4F, 0.6F}, projectors);
    scene.compensation = false; // so that the light falls off visibly
    scene.deviceColor = {0.8F, 0.9F, 0.6F};
    scene.tableColor = {0.7F, 0.6F, 0.9F};
    const ShowFrame frame = frameOf(scene, liftedFlaps());
    renderer.draw(frame);
    const Lab lab(labOf(frame, renderer));
    const CalibratedCamera low = cameraLookingAt({-0.5, 0.35, 0.5}, {0.0, 0.0, 0.0}, {400, 300}, 500.0);
    for (const CalibratedCamera& observer : {kAbove, low}) {
        const Difference difference = between(renderer.readLab(observer), lab.view(observer, 1));
        EXPECT_LT(difference.mean, 0.6);
        EXPECT_LT(difference.muchShare, 0.01);
    }
}

// The lab knows the true colours of what the light falls on, and its projectors' colours.
TEST(SpatialRendererInRoom, MakesUpForColouredSurfacesAndProjectors) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    SceneInRoom scene = unlitScene({0.5F, 0.3F, 0.2F}, {0.1F, 0.4F, 0.3F}, {pair()[0]});
    scene.projectors[0].peak = 3.0;
    const ShowFrame white = frameOf(scene, liftedFlaps());
    renderer.draw(white);
    const Image wanted = Lab(labOf(white, renderer)).view(kAbove, 1);
    scene.deviceColor = {0.9F, 0.7F, 0.8F};
    scene.tableColor = {0.6F, 0.8F, 0.9F};
    scene.projectors[0].gain = {0.8F, 1.0F, 1.2F};
    const ShowFrame colored = frameOf(scene, liftedFlaps());
    LabWorld uncorrected = labOf(white, renderer);
    const LabWorld truth = labOf(colored, renderer);
    uncorrected.surfaces = truth.surfaces;
    renderer.draw(colored);
    const Image right = Lab(labOf(colored, renderer)).view(kAbove, 1);
    const Image wrong = Lab(uncorrected).view(kAbove, 1);
    const Difference after = between(right, wanted);
    EXPECT_LT(after.mean, 0.8);
    EXPECT_LT(after.muchShare, 0.01);
    EXPECT_GT(between(wrong, wanted).mean, 8.0);
}

TEST(SpatialRendererInRoom, MaskIsWhiteWhereEyeAndProjectorMeet) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    renderer.setEyeSize({320, 200});
    const std::vector<InstalledProjector> projectors{pair()[0]};
    const ShowFrame frame = frameOf(unlitScene(glm::vec3(0.7F), glm::vec3(0.7F), projectors), liftedFlaps());
    renderer.draw(frame);
    const Image mask = renderer.readMask();
    const Lab lab(labOf(frame, renderer));
    const CalibratedCamera eye = deviceView(frame, *frame.eye, {320, 200});
    int white = 0;
    int black = 0;
    int wrong = 0;
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 320; ++x) {
            const auto hit = lab.trace(positionOf(eye), directionOf(eye, {x, y}));
            const bool lit = hit && lab.lit(0, hit->point, hit->normal);
            const bool shown = mask.at(x, y)[0] > 127;
            (lit ? white : black) += 1;
            wrong += lit == shown ? 0 : 1;
        }
    EXPECT_GT(white, 20'000);
    EXPECT_GT(black, 3'000);
    EXPECT_LT(wrong, 64'000 / 100);
}

} // namespace
} // namespace lumorph
