#include "app/applications/water/water_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "app/applications/demo_items.h"
#include "app/applications/water/sea_pictures.h"
#include "app/applications/water/water.h"

namespace lumorph {

using sea::Float;

namespace {

constexpr double kNotch = 0.08;       ///< of the storm
constexpr double kHeldSpeed = 0.4;    ///< of the storm, a second
constexpr double kStormTime = 0.8;    ///< seconds in which waves follow
constexpr double kMostStep = 0.1;     ///< seconds; after a pause the rest is left out
constexpr double kHandOn = 0.010;     ///< metres over the water in which a hand touches it
constexpr double kWake = 0.012;       ///< metres between the touches of a pointer that is drawn over the water
constexpr double kWakeTime = 0.14;    ///< seconds between them, at least
constexpr double kThrownFrom = 0.075; ///< metres over the water
constexpr double kOwnFirst = 1.0, kOwnEvery = 5.0; ///< seconds, of the drops that fall by themselves
constexpr std::size_t kOwnFloats = 4;
constexpr double kOwnSpeed = 0.020; ///< of the boat that sails by itself, metres a second
constexpr glm::dvec2 kBoatFrom{-0.005, 0.040};
constexpr double kBeaconRadius = 0.0074; ///< metres
constexpr float kBoatScale = 1.2F;
constexpr const char* kSeaModel = "sea surface";
enum ProgramItem : int { kSeaItem = 60, kBoatItem, kBeaconItem, kLampItem, kGlowItem, kFirstThrown = 100 };

bool isAfloat(const SceneItem& item) { return std::holds_alternative<ShapeItem>(item.kind); }

SceneItem modelItem(int id, const char* name, const char* model) {
    return demoItem(id, name, MeshItem{.model = model});
}

glm::dvec2 ownPlace(int number) {
    const glm::dvec2 at(0.37 * number, 9.5);
    return 0.72 * sea::Ripples::kHalf * glm::dvec2(sea::softNoise(at * 7.0, 31), sea::softNoise(at * 7.0, 32));
}

} // namespace

WaterProgram::WaterProgram() : still_(waterScene()) {
    auto assets = std::make_shared<SceneAssets>(*loadSceneAssets(still_, {}));
    sea::addSeaPictures(*assets);
    sea::addHarbourModels(*assets);
    assets_ = std::move(assets);
    for (const SceneItem& item : still_.items) {
        if (isAfloat(item)) addFirst(item);
        if (const auto* heights = std::get_if<HeightItem>(&item.kind)) waves_ = heights->waves;
    }
    std::erase_if(still_.items, [](const SceneItem& item) {
        return isAfloat(item) || std::holds_alternative<HeightItem>(item.kind);
    });
    const Words title{"A sea you can feel", "Ein Meer, das man fühlt"};
    caption_ = std::make_shared<const ShowCaption>(ShowCaption{
        title,
        {"Touch the water, or lean it: bring the boat into the ring of light. The wheel, + and - make storm "
         "or calm; N throws something in.",
         "Berühre oder neige das Wasser: Bring das Boot in den Lichtring. Das Rad, + und - machen Sturm "
         "oder Stille; N wirft etwas hinein."}});
    arrived_ = std::make_shared<const ShowCaption>(ShowCaption{
        title,
        {"Safe in the harbour! The next light is coming up.", "Sicher im Hafen! Das nächste Licht taucht schon auf."}});
    begin();
}

void WaterProgram::addFirst(const SceneItem& item) {
    const auto& shape = std::get<ShapeItem>(item.kind);
    Float one;
    one.item = item;
    one.item.motion = {};
    one.home = one.at = {item.position.x, item.position.z};
    one.half = 0.5 * glm::dvec2(shape.size.x, shape.size.z);
    one.radius = 0.5 * std::max(shape.size.x, shape.size.z);
    one.lift = 0.12 * shape.size.y;
    first_.push_back(std::move(one));
}

void WaterProgram::begin() {
    floats_ = first_;
    boat_ = {};
    boat_.item = modelItem(kBoatItem, "Boat", sea::kBoatModel);
    boat_.at = kBoatFrom;
    boat_.item.scale = glm::vec3(kBoatScale);
    boat_.half = static_cast<double>(kBoatScale) * glm::dvec2(0.0145, 0.0052);
    boat_.radius = 0.013;
    boat_.homesick = 0.0;
    boat_.sails = true;
    harbour_ = {};
    wanted_ = 1.0;
    held_ = 0.0;
    alone_ = 0.0;
    played_ = 0;
}

void WaterProgram::hear(const char* sound, double strength, const glm::dvec2& place) {
    sounds_.push_back({sound, strength, {glm::dvec3(place.x, sea::SeaSurface::kLevel, place.y)}});
}

void WaterProgram::touch(const glm::dvec2& place, double strength) {
    ripples_.touch(place, strength);
    hear("water.drop", std::min(1.0, strength), place);
}

void WaterProgram::listen(const ShowMoment& moment) {
    visitor_.take(moment);
    for (const ShowInput& input : moment.inputs) {
        if (!std::isfinite(input.value)) continue;
        if (input.name == "wheel") wanted_ += kNotch * std::clamp(input.value, -8.0, 8.0);
        if (input.name == "key.in") held_ = input.value > 0.5 ? 1.0 : 0.0;
        if (input.name == "key.out") held_ = input.value > 0.5 ? -1.0 : 0.0;
        if (input.name == "pointer.held") pressed_ = input.value > 0.5;
    }
    const double step = std::clamp(moment.step, 0.0, kMostStep);
    if (visitor_.next()) throwIn();
    if (visitor_.restart() || visitor_.left()) begin();
    takeHands(moment);
    takePointer(step);
    if (!visitor_.there() && hands_.empty()) play(step);
    wanted_ = std::clamp(wanted_ + kHeldSpeed * held_ * step, kCalmest, kStormiest);
    storm_ += (wanted_ - storm_) * (1.0 - std::exp(-step / kStormTime));
    slosh_.advance(moment.step, visitor_.lean());
}

/// A tracked hand that reaches the water touches it once; poses that are not finite are ignored.
void WaterProgram::takeHands(const ShowMoment& moment) {
    const glm::dmat4 deviceFromWorld = glm::inverse(glm::dmat4(moment.worldFromDevice));
    std::set<std::string> on;
    for (const ShowBody& body : moment.bodies) {
        if (body.role != PoseRole::pointer) continue;
        const glm::dvec4 at = deviceFromWorld * glm::dvec4(body.pose.position, 1.0);
        const glm::dvec2 place(at.x, at.z);
        if (!std::isfinite(at.x + at.y + at.z) || glm::any(glm::greaterThan(glm::abs(place), sea::Ripples::kHalf)))
            continue;
        // What lies under the device is put away, and no hand.
        if (at.y < 0.0 || at.y - sea::SeaSurface::kLevel - water_.heightAt(place) > kHandOn) continue;
        if (!hands_.contains(body.name)) touch(place, 1.0);
        on.insert(body.name);
    }
    hands_ = std::move(on);
}

/// A press makes a ring; drawn on, it leaves a wake of small ones.
void WaterProgram::takePointer(double step) {
    sinceTouch_ += step;
    if (!pressed_ || !visitor_.pointer()) return touched_.reset();
    const glm::dvec2 place = *visitor_.pointer() * sea::Ripples::kHalf;
    const bool first = !touched_;
    if (!first && (sinceTouch_ < kWakeTime || glm::distance(*touched_, place) < kWake)) return;
    touch(place, first ? 1.0 : 0.45);
    touched_ = place;
    sinceTouch_ = 0.0;
}

/// Nobody there: drops fall, now and then something is thrown in, and the boat sails.
void WaterProgram::play(double step) {
    alone_ += step;
    sailHome();
    if (alone_ < kOwnFirst + kOwnEvery * played_) return;
    ++played_;
    if (played_ % 4 == 0)
        throwIn();
    else
        touch(ownPlace(played_), 0.8);
}

/// Straight to the beacon, and on past others: they are pushed aside.
void WaterProgram::sailHome() {
    const glm::dvec2 way = harbour_.place() - boat_.at;
    const double far = glm::length(way);
    if (harbour_.shining() || far < 0.5 * sea::Harbour::kReach) return;
    boat_.velocity = glm::mix(boat_.velocity, way * (kOwnSpeed / far), 0.03);
}

/// Now a ball, now a box, each beside the last; the oldest that was thrown goes where there are too many.
void WaterProgram::throwIn() {
    constexpr std::array<glm::vec3, 4> kColors{
        {{0.95F, 0.78F, 0.18F}, {0.22F, 0.55F, 0.90F}, {0.93F, 0.93F, 0.90F}, {0.30F, 0.72F, 0.40F}}};
    const std::size_t most = visitor_.there() ? kMostFloats : kOwnFloats;
    if (floats_.size() >= most) floats_.erase(floats_.begin() + static_cast<std::ptrdiff_t>(first_.size()));
    int id = kFirstThrown;
    while (std::ranges::find(floats_, id, [](const Float& one) { return one.item.id; }) != floats_.end()) ++id;
    const auto number = static_cast<std::size_t>(id - kFirstThrown);
    Float one = first_[number % first_.size()];
    one.item.id = id;
    one.item.name = "Thrown in " + std::to_string(number + 1);
    std::get<ShapeItem>(one.item.kind).size *= 0.75F;
    one.item.material.color = kColors[number % kColors.size()];
    one.item.material.colorTexture = {}; // painted
    one.half *= 0.75;
    one.radius *= 0.75;
    one.lift *= 0.75;
    one.above = kThrownFrom;
    const double turn = 2.4 * static_cast<double>(number); // the golden angle spreads them
    one.home = one.at = 0.6 * sea::Ripples::kHalf * glm::dvec2(std::cos(turn), std::sin(turn));
    floats_.push_back(std::move(one));
}

std::vector<Float*> WaterProgram::afloat() {
    std::vector<Float*> all{&boat_};
    for (Float& one : floats_) all.push_back(&one);
    return all;
}

void WaterProgram::advance(const ShowMoment& moment, double step) {
    ripples_.advance(step);
    water_.setHeights(waves_, storm_, moment.seconds, slosh_, ripples_);
    std::vector<Float*> all = afloat();
    std::vector<sea::Waterline> lines;
    for (Float* one : all) {
        if (drift(*one, water_, {slosh_.slope(), &ripples_}, step)) {
            ripples_.touch(one->at, 1.3);
            water_.splash(one->at, 1.1 * one->radius);
            hear("water.splash", 0.8, one->at);
        }
        if (one->above <= 0.0) lines.push_back(one->waterline());
    }
    Float beacon; // things go round it
    beacon.at = harbour_.place();
    beacon.radius = kBeaconRadius * harbour_.up();
    all.push_back(&beacon);
    keepApart(all);
    if (harbour_.advance(step, boat_.at)) {
        hear("water.harbour", 1.0, harbour_.place());
        ripples_.touch(harbour_.place(), 0.6);
    }
    if (harbour_.up() > 0.5) lines.push_back({harbour_.place(), glm::dvec2(kBeaconRadius), kBeaconRadius, 0.0});
    water_.advanceFoam(step, lines);
}

/// The beacon, its lamp, and the ring of light: it breathes, and runs out once the boat has come.
void WaterProgram::showHarbour(Scene& scene) const {
    const glm::dvec2& place = harbour_.place();
    const double sunk = 0.034 * (1.0 - harbour_.up());
    const double level = sea::SeaSurface::kLevel + water_.heightAt(place) - sunk;
    SceneItem beacon = modelItem(kBeaconItem, "Beacon", sea::kBeaconModel);
    beacon.position = {glm::dvec3(place.x, level, place.y)};
    beacon.rotation = sea::alongSlope(0.5 * water_.slopeAt(place));
    SceneItem lamp = modelItem(kLampItem, "Lamp", sea::kLampModel);
    std::get<MeshItem>(lamp.kind).ownMaterials = false;
    lamp.scale = glm::vec3(0.0033F);
    lamp.position = beacon.position + beacon.rotation * glm::vec3(0.0F, static_cast<float>(sea::kBeaconHigh), 0.0F);
    lamp.material.color = {1.0F, 0.86F, 0.45F};
    lamp.material.emission = {1.0F, 0.78F, 0.32F};
    lamp.material.emissionStrength = harbour_.shining() ? 2.0F : 0.7F;
    SceneItem glow = modelItem(kGlowItem, "Harbour", sea::kGlowModel);
    glow.opacity = static_cast<float>(harbour_.up() * (harbour_.shining() ? 1.0 : 0.72));
    glow.visible = glow.opacity > 0.02F;
    scene.items.insert(scene.items.end(), {std::move(beacon), std::move(lamp), std::move(glow)});
}

std::shared_ptr<const SceneAssets> WaterProgram::assetsNow() const {
    auto assets = std::make_shared<SceneAssets>(*assets_);
    assets->models[kSeaModel] = water_.model();
    const double run = harbour_.shone();
    const double radius = sea::Harbour::kReach + 0.010 * (1.0 - (1.0 - run) * (1.0 - run));
    assets->models[sea::kGlowModel] =
        sea::glowModel(harbour_.place(), radius, harbour_.shining() ? 0.010 : 0.006,
                       [this](const glm::dvec2& at) { return sea::SeaSurface::kLevel + water_.heightAt(at); });
    return assets;
}

ShowContent WaterProgram::frame(const ShowMoment& moment) {
    sounds_.clear();
    listen(moment);
    advance(moment, std::clamp(moment.step, 0.0, kMostStep));
    auto scene = std::make_shared<Scene>(still_);
    scene->items.push_back(modelItem(kSeaItem, "Sea", kSeaModel));
    for (const Float* one : afloat()) scene->items.push_back(one->item);
    showHarbour(*scene);
    ShowContent content;
    content.scene = std::move(scene);
    content.assets = assetsNow();
    content.caption = harbour_.shining() ? arrived_ : caption_;
    content.target = water_.heights();
    content.following = Following::split;
    content.sounds = std::move(sounds_);
    return content;
}

} // namespace lumorph
