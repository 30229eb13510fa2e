#include "app/applications/navigation/navigation.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "app/applications/demo_items.h"
#include "app/applications/navigation/import_caption.h"
#include "app/applications/navigation/map_import.h"
#include "app/applications/navigation/map_model.h"
#include "app/applications/navigation/noise.h"
#include "app/applications/navigation/palette.h"
#include "app/applications/navigation/search.h"
#include "app/applications/navigation/valley.h"
#include "core/base/error.h"

namespace lumorph::navigation {
namespace {

constexpr const char* kLandModel = "navigation land"; ///< assets that are in memory alone
constexpr const char* kRainModel = "navigation rain";
constexpr double kPanSpeed = 0.075;             ///< device metres a second at full lean
constexpr double kZoomSpeed = 0.9;              ///< by which the width's logarithm changes, a second
constexpr double kWheel = 0.16;                 ///< the same a notch of the wheel
constexpr double kIdle = 12.0;                  ///< seconds until it goes back to the last place
constexpr double kTurnSpeed = 0.7;              ///< radians a second
constexpr double kDrift = 0.045;                ///< radians a second by which it turns without visitors
constexpr double kSmooth = 0.18;                ///< seconds in which panning follows the hand
constexpr double kStay = 4.5;                   ///< seconds at a place
constexpr double kTold = 30.0;                  ///< seconds in which the report of an import is read
constexpr double kNarrowest = 140.0;            ///< metres
constexpr double kLookAhead = 0.8;              ///< seconds
constexpr double kCloudHeight = 0.082;          ///< y of the cloud, device metres
constexpr float kPuff = 0.019F;                 ///< metres
constexpr glm::dvec2 kDriftReach{0.055, 0.026}; ///< of a cloud that no hand leads, device metres
constexpr glm::dvec2 kDriftTurn{26.0, 17.0};    ///< seconds

Scene settingOf() {
    Scene scene = defaultScene();
    scene.device.show = DeviceSkin::Show::content;
    scene.sky = {0.27F, 0.31F, 0.38F};
    SceneItem& sun = scene.items.front();
    sun.id = kSunItem;
    sun.position = {-0.62F, 0.62F, -0.42F};
    std::get<LightItem>(sun.kind).intensity = 1.08;
    std::get<LightItem>(sun.kind).color = {1.0F, 0.95F, 0.86F};
    std::get<LightItem>(sun.kind).softness = 0.05;
    SceneItem land = demoItem(kLandItem, "Land", MeshItem{.model = kLandModel, .animation = -1});
    scene.items.push_back(std::move(land));
    return scene;
}

std::shared_ptr<const SceneAssets> stillAssets(const Labels& labels, const Inset& inset) {
    // The pictures of table and water.
    Scene all = defaultScene();
    SceneItem water = demoItem(2, "Water", ShapeItem{});
    water.material = waterMaterial();
    all.items.push_back(std::move(water));
    auto assets = std::make_shared<SceneAssets>(*loadSceneAssets(all, {}));
    assets->images[kPaletteImage] = paletteImage();
    assets->images[kRainImage] = rainImage();
    labels.addTo(*assets);
    inset.addTo(*assets);
    return assets;
}

void addCloud(Scene& scene, const glm::dvec2& at) {
    constexpr struct {
        float x, y, z, size;
    } kPuffs[] = {{0.0F, 0.001F, 0.0F, 1.25F},   {-0.019F, -0.001F, 0.002F, 0.95F}, {0.018F, -0.001F, -0.001F, 1.0F},
                  {0.006F, 0.0F, 0.013F, 0.85F}, {-0.009F, 0.001F, -0.013F, 0.9F},  {0.031F, -0.003F, 0.004F, 0.6F}};
    for (int k = 0; k < 6; ++k) {
        const auto& puff = kPuffs[k];
        SceneItem item = demoItem(
            kFirstCloud + k, "Cloud",
            ShapeItem{ShapeItem::Form::sphere, glm::vec3(kPuff) * glm::vec3(puff.size, 0.6F * puff.size, puff.size)});
        item.position = glm::vec3(glm::dvec3(at.x, kCloudHeight, at.y)) + glm::vec3(puff.x, puff.y, puff.z);
        item.material.name = "Cloud";
        item.material.color = {0.78F, 0.81F, 0.86F};
        item.material.roughness = 1.0F;
        item.opacity = 0.9F;
        scene.items.push_back(std::move(item));
    }
}

glm::dvec3 eyeOf(const ShowMoment& moment) {
    const glm::dvec3 eye(moment.eye.value_or(moment.installation->eye));
    return glm::dvec3(glm::inverse(glm::dmat4(moment.worldFromDevice)) * glm::dvec4(eye, 1.0));
}

Bending bendingOf(const DemoTold& told) {
    const auto bend = told.find("bend");
    if (bend == told.end() || bend->second == "off") return Bending::off;
    if (bend->second == "on") return Bending::on;
    if (bend->second == "beside") return Bending::beside;
    throw InvalidInput("bend '" + bend->second + "'", "it is no way to bend", "say off, on or beside");
}

std::shared_ptr<const ShowCaption> comparingCaption() {
    return std::make_shared<const ShowCaption>(ShowCaption{
        {"Without and with bending", "Ohne und mit Biegen"},
        {"On the left what rises behind the tablet lies flat on the table or is missing; on the right the far edge "
         "comes up for you, and carries it.",
         "Links liegt flach auf dem Tisch, was hinter dem Tablet aufragt, oder es fehlt; rechts kommt dir "
         "die ferne Kante entgegen und trägt es."}});
}

std::unique_ptr<ShowProgram> begin(const ProgramStart& start, const Progress& progress) {
    const DemoTold& told = start.told;
    const Bending bending = bendingOf(told); // before the map, which takes its time
    const auto map = told.find("map"), place = told.find("goto");
    std::shared_ptr<const Map> shown;
    std::optional<ShowCaption> report;
    if (map == told.end()) {
        shown = std::make_shared<const Map>(bundledValley(29, progress));
    } else {
        ImportedMap imported = importMap(map->second, progress);
        for (const Words& note : imported.report.notes) start.note(note.english); // a host's language
        start.figures("map", figuresOf(imported));
        report = importCaption(imported.report, std::filesystem::path(map->second).filename().string());
        shown = std::make_shared<const Map>(std::move(imported.map));
    }
    auto program = std::make_unique<NavigationProgram>(start.seed, std::move(shown), bending);
    if (report) program->tell(std::move(*report));
    if (place != told.end()) program->flyTo(place->second);
    return program;
}

} // namespace

NavigationProgram::NavigationProgram(std::uint64_t seed, std::shared_ptr<const Map> map, Bending bending)
    : map_(std::move(map)), seed_(seed), rain_(seed), labels_(*map_), setting_(settingOf()), usual_(bending),
      bending_(bending), comparing_(comparingCaption()) {
    if (map_->heights.heights().empty() || map_->cover.size() != map_->heights.heights().size())
        throw InvalidInput("map", "it has no heights, or no cover for each of them", "read it again");
    inset_.emplace(*map_);
    still_ = stillAssets(labels_, *inset_);
    whole_ = std::make_unique<GroundPicture>(*map_, wholeWindow(*map_));
    while (!whole_->paint(GroundPicture::kSide * GroundPicture::kSide)) {
    }
    view_ = home();
    rested_ = kStay - 2.0;
}

MapView NavigationProgram::home() const noexcept {
    const glm::dvec2 size = map_->heights.size();
    return {0.5 * size, wholeView(size), 0.0};
}

void NavigationProgram::flyTo(const std::string& name) {
    const std::optional<std::size_t> place = find(map_->places, name);
    if (place) return fly(viewOf(map_->places[*place], view_.turn));
    std::string names;
    for (const Place& known : map_->places) names += (names.empty() ? "" : ", ") + known.name.english;
    throw InvalidInput("place '" + name + "'", "the map has none of that name", "choose one of " + names);
}

MapView NavigationProgram::viewOf(const Place& place, double turn) const {
    const MapView view = within({place.at, place.width, turn}, map_->heights.size(), kNarrowest);
    return bestTurn_ ? bestTurn_->of(*map_, view) : view;
}

void NavigationProgram::tell(ShowCaption caption) { told_ = std::make_shared<const ShowCaption>(std::move(caption)); }

void NavigationProgram::fly(const MapView& to) {
    flight_.emplace(view_, to);
    flown_ = rested_ = 0.0;
    velocity_ = {};
}

void NavigationProgram::listen(const ShowMoment& moment) {
    if (moment.rig && moment.rig != rig_) {
        rig_ = moment.rig;
        bestTurn_.emplace(*rig_);
    }
    visitor_.take(moment);
    for (const ShowInput& input : moment.inputs) {
        const double held = input.value > 0.5 ? 1.0 : 0.0;
        if (input.name == "key.in") in_ = held;
        if (input.name == "key.out") out_ = held;
        if (input.name == "wheel" && std::isfinite(input.value)) wheel_ += std::clamp(input.value, -8.0, 8.0);
        if (input.name == "key.turnLeft") left_ = held;
        if (input.name == "key.turnRight") right_ = held;
        if (input.name == "key.rain") {
            if (!raining_) drifted_ = 0.0;
            raining_ = held > 0.0;
        }
        if (input.name == "key.bend" && held > 0.0) bending_ = bending_ == Bending::on ? Bending::off : Bending::on;
        if (input.name == "key.off" && held > 0.0)
            bending_ = bending_ == Bending::beside ? Bending::off : Bending::beside;
    }
    if (visitor_.left()) in_ = out_ = left_ = right_ = 0.0, raining_ = false, bending_ = usual_;
}

void NavigationProgram::move(double step) {
    if (visitor_.came()) flight_.reset();
    if (visitor_.came() || visitor_.restart()) last_.reset();
    if (visitor_.restart()) fly(home());
    if (visitor_.next() && !map_->places.empty()) {
        last_ = visited_++ % map_->places.size();
        fly(viewOf(map_->places[*last_], view_.turn));
    }
    if (visitor_.there())
        steer(step);
    else
        tour(step);
    if (!flight_) return;
    flown_ += step;
    view_ = within(flight_->at(flown_), map_->heights.size(), kNarrowest);
    if (flown_ >= flight_->seconds()) flight_.reset();
}

void NavigationProgram::tour(double step) {
    if (flight_) return;
    view_.turn += kDrift * step;
    view_ = within(view_, map_->heights.size(), kNarrowest);
    rested_ += step;
    if (rested_ < kStay) return;
    const auto stop = static_cast<int>(visited_++);
    const std::size_t places = map_->places.size();
    if (places == 0 || stop % 5 == 4) return fly(home());
    const double turn = view_.turn + 1.6 * (chanceOf({stop, 7}, seed_) - 0.3);
    fly(viewOf(map_->places[static_cast<std::size_t>(stop) * 3 % places], turn));
}

void NavigationProgram::steer(double step) {
    const glm::dvec2 lean = visitor_.lively() / Visitor::kMostLean;
    const bool asks = glm::length(lean) > 0.1, moves = asks || wheel_ != 0.0 || in_ + out_ + left_ + right_ > 0.0;
    if (moves) flight_.reset();
    idle_ = moves ? 0.0 : idle_ + step;
    if (idle_ > kIdle && idle_ - step <= kIdle && !flight_)
        fly(last_ ? viewOf(map_->places[*last_], view_.turn) : home());
    if (flight_) return;
    const glm::dvec2 wanted = asks ? kPanSpeed * lean : glm::dvec2(0.0);
    velocity_ = glm::mix(wanted, velocity_, std::exp(-step / kSmooth));
    if (glm::length(velocity_) < 1e-4) velocity_ = {};
    view_.width *= std::exp(kZoomSpeed * step * (out_ - in_) - kWheel * std::exchange(wheel_, 0.0));
    view_.turn += kTurnSpeed * step * (right_ - left_);
    view_.centre = view_.placeAt(velocity_ * step);
    view_ = within(view_, map_->heights.size(), kNarrowest);
}

/// A sharper picture of where it goes is begun as soon as there is none; until it is done an older one serves.
void NavigationProgram::paintGround() {
    MapView target = flight_ ? flight_->end() : view_;
    if (!flight_) target.centre = view_.placeAt(velocity_ * kLookAhead);
    const PictureWindow wanted = windowFor(target);
    const auto serves = [&](const std::unique_ptr<GroundPicture>& picture) {
        return picture && picture->window().covers(target) && picture->window().side < 1.01 * wanted.side;
    };
    if (!serves(sharp_) && !serves(making_) && wanted.side < 0.8 * whole_->window().side)
        making_ = std::make_unique<GroundPicture>(*map_, wanted);
    if (!making_) return;
    if (making_->paint(GroundPicture::kFramePixels)) sharp_ = std::move(making_);
}

const GroundPicture& NavigationProgram::picture() const {
    return sharp_ && sharp_->window().covers(view_) && sharp_->window().side < whole_->window().side ? *sharp_
                                                                                                     : *whole_;
}

/// What stays the same keeps its identity, so that nobody has to look at it again.
void NavigationProgram::makeLand(double step) {
    const GroundPicture& shown = picture();
    const bool same = ground_ && ground_->settled() && ground_->view() == view_ && window_ == shown.window() &&
                      swell_ == rain_.swell();
    if (same && land_) return;
    if (!ground_ || !ground_->settled() || ground_->view() != view_)
        ground_ = ViewGround(*map_, view_, ground_ ? &*ground_ : nullptr, step);
    window_ = shown.window();
    swell_ = rain_.swell();
    land_ = std::make_shared<const SceneModel>(landModel(*map_, *ground_, window_, swell_));
    auto assets = std::make_shared<SceneAssets>(*still_);
    assets->models[kLandModel] = land_;
    assets->images[kGroundImage] = shown.color();
    assets->images[kReliefImage] = shown.relief();
    assets_ = std::move(assets);
}

/// From a hand that is held over the device, or from a cloud that drifts over it while a key is held.
void NavigationProgram::letRain(const ShowMoment& moment) {
    constexpr double kHeld = 0.35; // metres over the device, at most
    cloud_.reset();
    if (raining_) {
        const glm::dvec2 turn = 2.0 * std::numbers::pi * drifted_ / kDriftTurn;
        cloud_ = kDriftReach * glm::dvec2(-std::cos(turn.x), std::sin(turn.y));
        drifted_ += moment.step;
    }
    for (const ShowBody& body : moment.bodies) {
        if (body.role != PoseRole::pointer) continue;
        const glm::dvec3 at(glm::inverse(glm::dmat4(moment.worldFromDevice)) * matrixOf(body.pose)[3]);
        const glm::dvec2 inside = kHalf - glm::abs(glm::dvec2(at.x, at.z));
        if (std::min(inside.x, inside.y) > 0.0 && at.y > 0.0 && at.y < kHeld) cloud_ = glm::dvec2(at.x, at.z);
    }
    rain_.advance(*map_, view_, cloud_, moment.step);
}

std::shared_ptr<const Scene> NavigationProgram::scene(const ShowMoment& moment) {
    labels_.arrange(*map_, *ground_, eyeOf(moment), moment.language, moment.step);
    auto scene = std::make_shared<Scene>(setting_);
    scene->viewDependence.on = bending_ != Bending::off;
    labels_.show(*scene);
    inset_->show(*scene, *ground_, eyeOf(moment));
    if (cloud_) addCloud(*scene, *cloud_);
    if (rain_.dry()) return scene;
    SceneItem water =
        demoItem(kRainItem, "Rain", MeshItem{.model = kRainModel, .animation = -1, .ownMaterials = false});
    water.material.name = "Running water";
    water.material.colorTexture.image = kRainImage;
    water.material.colorTexture.tile = glm::vec2(1.0F);
    water.material.color = glm::vec3(1.0F);
    water.material.unlit = true;
    water.material.alpha = Material::Alpha::blend;
    scene->items.push_back(std::move(water));
    return scene;
}

ShowContent NavigationProgram::frame(const ShowMoment& moment) {
    listen(moment);
    move(moment.step);
    paintGround();
    makeLand(moment.step);
    letRain(moment);
    ShowContent content;
    content.scene = scene(moment);
    content.assets = assets_;
    if (!rain_.dry()) {
        auto assets = std::make_shared<SceneAssets>(*assets_);
        assets->models[kRainModel] = std::make_shared<const SceneModel>(rain_.model(*map_, *ground_, kCloudHeight));
        content.assets = std::move(assets);
    }
    content.target = ground_->grid();
    content.following = Following::split;
    content.comparesBend = bending_ == Bending::beside;
    if (content.comparesBend) content.caption = comparing_;
    if (told_ && moment.seconds < kTold) content.caption = told_;
    return content;
}

Demo navigationDemo() {
    return {
        .name = "navigation",
        .title = {"A map that rises to meet you", "Eine Karte, die dir entgegenwächst"},
        .sentence = {"Fly over a valley and its harbour town: the tablet takes the land's shape, wherever you look.",
                     "Flieg über ein Tal mit seiner Hafenstadt: Das Tablet nimmt die Form des Landes an, wohin du auch "
                     "schaust."},
        .thumbnail = "thumbnails/navigation.png",
        .open = bundledTablet,
        .program = begin,
        .options = {{"map",
                     "A map of one's own: a file or folder of heights (GeoTIFF, 16-bit PNG, .hgt) and of outlines "
                     "(GeoJSON, CityJSON, .osm, .pbf)",
                     {"Map", "Karte"},
                     {"heights and outlines: GeoTIFF, PNG, .hgt, GeoJSON, CityJSON, .osm, .pbf",
                      "Höhen und Umrisse: GeoTIFF, PNG, .hgt, GeoJSON, CityJSON, .osm, .pbf"},
                     true},
                    {"goto",
                     "A place to fly to at first, by its name or some of it",
                     {"Begin at", "Beginnen bei"},
                     {"name of a place", "Name eines Ortes"}},
                    {"bend",
                     "How the device bends for who looks: off, on, or beside (without and with it beside each other)",
                     {"Bend for who looks", "Für den Betrachter biegen"},
                     {"off, on, or beside: both beside each other",
                      "off (nicht), on (ja) oder beside: beides nebeneinander"}}},
        .compares = true};
}

} // namespace lumorph::navigation
