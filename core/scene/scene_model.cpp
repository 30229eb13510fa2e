#include "core/scene/scene_model.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/gltf_reader.h"

namespace lumorph {
namespace {

using nlohmann::json;

float encoded(float linear) {
    const float value = std::clamp(linear, 0.0F, 1.0F);
    return value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1.0F / 2.4F) - 0.055F;
}

glm::vec3 encoded(const glm::vec3& linear) { return {encoded(linear.r), encoded(linear.g), encoded(linear.b)}; }

/// Mean of each channel, in [0, 1]. Our materials have one roughness, metallic share and glow a surface; of a picture
/// of them the mean is the nearest.
glm::vec3 mean(const Image& image) {
    glm::dvec3 sum(0.0);
    for (const Image::Pixel& p : image.pixels()) sum += glm::dvec3(p[0], p[1], p[2]);
    return {sum / (255.0 * static_cast<double>(std::max<std::size_t>(image.pixels().size(), 1)))};
}

/// A number of `extras` where it is one in range; else what it was.
void read(const json& object, const char* key, double min, double max, auto& value) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_number()) return;
    const auto number = found->get<double>();
    if (number >= min && number <= max) value = static_cast<std::remove_reference_t<decltype(value)>>(number);
}

/// What artists may say of a texture's motion: `lumorph: {flipBook: {columns, rows, framesPerSecond}, uvVelocity: [u,
/// v]}`.
void readMotion(const json& extras, SceneTexture& texture) {
    if (!extras.is_object() || !extras.contains("lumorph") || !extras["lumorph"].is_object()) return;
    const json& ours = extras["lumorph"];
    if (const auto book = ours.find("flipBook"); book != ours.end() && book->is_object()) {
        read(*book, "columns", 1, 256, texture.columns);
        read(*book, "rows", 1, 256, texture.rows);
        read(*book, "framesPerSecond", 0.0, 1000.0, texture.framesPerSecond);
    }
    const auto velocity = ours.find("uvVelocity");
    if (velocity == ours.end() || !velocity->is_array() || velocity->size() != 2) return;
    const json named = {{"u", (*velocity)[0]}, {"v", (*velocity)[1]}};
    read(named, "u", -1e3, 1e3, texture.velocity.x);
    read(named, "v", -1e3, 1e3, texture.velocity.y);
}

class Loader {
public:
    Loader(const std::filesystem::path& file, const std::string& name, PictureBudget& budget, const Progress& progress)
        : name_(name), budget_(budget), progress_(progress), scene_(std::make_shared<SceneModel>()) {
        ReadModel read = readModelFile(file);
        scene_->model = std::move(read.model);
        unread_ = std::move(read.unread);
        (void)flatten(scene_->model); // throws where a transform leads beyond all numbers
    }

    LoadedModel run() {
        for (const Model::Material& material : scene_->model.materials)
            scene_->materials.push_back(converted(material));
        // Decoded, they are not needed a second time.
        for (Model::Image& image : scene_->model.images) image.bytes = {};
        for (const std::string& warning : unread_)
            loaded_.problem += (loaded_.problem.empty() ? name_ + ": " : " ") + warning;
        loaded_.model = std::move(scene_);
        return std::move(loaded_);
    }

private:
    Material converted(const Model::Material& from) {
        Material to;
        if (!from.name.empty()) to.name = from.name;
        to.color = encoded(glm::vec3(from.baseColor));
        to.opacity = std::clamp(from.baseColor.a, 0.0F, 1.0F);
        to.colorTexture = texture(from.baseColorImage);
        to.normalMaps[0] = texture(from.normalImage);
        to.normalStrength = std::clamp(from.normalScale, -10.0F, 10.0F);
        to.alpha = from.alphaMode == "BLEND"  ? Material::Alpha::blend
                   : from.alphaMode == "MASK" ? Material::Alpha::cutout
                                              : Material::Alpha::opaque;
        if (to.alpha == Material::Alpha::opaque) to.opacity = 1.0F;
        to.holeThreshold = std::clamp(from.alphaCutoff, 0.0F, 1.0F);
        const glm::vec3 rough =
            from.metallicRoughnessImage < 0 ? glm::vec3(1.0F) : mean(picture(from.metallicRoughnessImage));
        to.roughness = std::clamp(from.roughness * rough.g, 0.0F, 1.0F);
        to.metallic = std::clamp(from.metallic * rough.b, 0.0F, 1.0F);
        const glm::vec3 glow = from.emissiveImage < 0 ? glm::vec3(1.0F) : mean(picture(from.emissiveImage));
        to.emission = encoded(from.emissive) * glow;
        for (SceneTexture* map : {&to.colorTexture, &to.normalMaps[0]})
            if (!map->image.empty()) readMotion(from.extras, *map);
        return to;
    }

    /// Over the whole of the texture coordinates.
    SceneTexture texture(int image) {
        SceneTexture texture;
        if (image < 0) return texture;
        (void)picture(image);
        texture.image = imageName(name_, image);
        texture.tile = glm::vec2(1.0F);
        return texture;
    }

    const Image& picture(int index) {
        std::shared_ptr<const Image>& image = loaded_.images[imageName(name_, index)];
        if (image) return *image;
        progress_.throwIfCancelled();
        const Model::Image& source = scene_->model.images[static_cast<std::size_t>(index)];
        const std::string called =
            name_ + ": picture " + (source.name.empty() ? std::to_string(index) : inQuotes(source.name));
        try {
            Image decoded = decodeImage(source.bytes, called);
            budget_.charge(decoded);
            image = std::make_shared<const Image>(std::move(decoded));
        } catch (const DataError& error) {
            // One that could not be read is named by the model's own warnings.
            if (loaded_.problem.empty() && !source.bytes.empty()) loaded_.problem = error.what();
            image = std::make_shared<const Image>(placeholderImage());
        }
        return *image;
    }

    const std::string& name_;
    PictureBudget& budget_;
    const Progress& progress_;
    std::shared_ptr<SceneModel> scene_;
    std::vector<std::string> unread_; ///< its pictures that are missing or broken
    LoadedModel loaded_;
};

} // namespace

Image placeholderImage() {
    Image image({16, 16});
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            image.at(x, y) = (x / 4 + y / 4) % 2 == 0 ? Image::Pixel{255, 0, 255, 255} : Image::Pixel{96, 96, 96, 255};
    return image;
}

void PictureBudget::charge(const Image& image) {
    if (image.pixels().size() > pixels)
        throw DataError("pictures", "together they take more than 1 GiB", "use smaller ones");
    pixels -= image.pixels().size();
}

LoadedModel loadSceneModel(const std::filesystem::path& file, const std::string& name, PictureBudget& budget,
                           const Progress& progress) {
    return Loader(file, name, budget, progress).run();
}

} // namespace lumorph
