#include "app/workspaces/scene/material_rows.h"

#include <QLabel>

#include "app/workspaces/scene/texture_rows.h"

namespace lumorph::studio {

namespace {

const FormRange kShare{Quantity::share, 0.0, 1.0};

class MaterialRows {
public:
    MaterialRows(SceneForm& form, Studio& studio, QString prefix, Part<Material> part,
                 std::function<bool(const StudioState&)> metres, std::function<bool(const StudioState&)> shown)
        : form_(form), studio_(studio), prefix_(std::move(prefix)), part_(std::move(part)), metres_(std::move(metres)),
          shown_(std::move(shown)) {}

    void addAll() {
        addSurface();
        addBumps();
        addMirror();
        addHoles();
        addGlow();
        form_.endSection();
    }

private:
    [[nodiscard]] FormWords words(const char* name, const QString& label, const QString& hint = {}) const {
        return {prefix_ + '.' + name, label, hint};
    }

    CollapsibleSection& section(const char* name, const QString& title, bool open) {
        CollapsibleSection& made = form_.section(prefix_ + ".section." + name, title, open);
        if (shown_) form_.showWhile(&made, shown_);
        return made;
    }

    void texture(const char* name, const QString& label, const Part<SceneTexture>& part) {
        addTextureRows(form_, studio_, prefix_ + '.' + name, label, part, metres_);
    }

    void addSurface() {
        section("surface", QObject::tr("Surface"), true);
        QLabel* name = form_.sentence(prefix_ + ".name");
        form_.onRefresh([name, part = part_](const StudioState& state) {
            if (const Material* material = part.read(state))
                name->setText(QObject::tr("%1. The library has others.").arg(QString::fromStdString(material->name)));
        });
        form_.color(
            words("color", QObject::tr("Colour"), QObject::tr("Multiplied with the picture")), part_,
            [](auto& material) -> auto& { return material.color; });
        texture("picture", QObject::tr("Picture"),
                memberOf<SceneTexture>(
                    part_, [](auto& material) -> auto& { return material.colorTexture; }));
        form_.number(
            words("roughness", QObject::tr("Roughness"), QObject::tr("0 % is polished, 100 % is chalk")),
            {Quantity::share, 0.0, 1.0, 0.7}, part_, [](auto& material) -> auto& { return material.roughness; });
        form_.number(
            words("metallic", QObject::tr("Metal")), kShare, part_,
            [](auto& material) -> auto& { return material.metallic; });
        form_.check(
            words("unlit", QObject::tr("Shows its colour whatever the light")), part_,
            [](auto& material) -> auto& { return material.unlit; });
    }

    void addBumps() {
        section("bumps", QObject::tr("Bumps"), false);
        texture("normal", QObject::tr("Bump map"),
                memberOf<SceneTexture>(
                    part_, [](auto& material) -> auto& { return material.normalMaps[0]; }));
        texture("normal2", QObject::tr("Second bump map"),
                memberOf<SceneTexture>(
                    part_, [](auto& material) -> auto& { return material.normalMaps[1]; }));
        form_.number(
            words("normalStrength", QObject::tr("Strength"), QObject::tr("How steep the bumps look")),
            {Quantity::share, 0.0, 4.0, 1.0}, part_, [](auto& material) -> auto& { return material.normalStrength; });
    }

    void addMirror() {
        section("mirror", QObject::tr("Mirror and glass"), false);
        form_.number(
            words("reflection", QObject::tr("Reflection"), QObject::tr("Share of table and sky it mirrors")), kShare,
            part_, [](auto& material) -> auto& { return material.reflection; });
        form_.number(
            words("refraction", QObject::tr("Refraction"),
                  QObject::tr("Share of the table that is seen through it, bent")),
            kShare, part_, [](auto& material) -> auto& { return material.refraction; });
        form_.number(
            words("index", QObject::tr("Refractive index"), QObject::tr("Water 1.33, glass 1.5")),
            {Quantity::plain, 1.0, 3.0, 1.33}, part_, [](auto& material) -> auto& { return material.refractiveIndex; });
    }

    void addHoles() {
        section("holes", QObject::tr("Transparency and holes"), false);
        form_.choice(
            words("alpha", QObject::tr("Transparency"), QObject::tr("What a picture's own transparency does")),
            {QObject::tr("None"), QObject::tr("Cut out"), QObject::tr("See-through")}, part_,
            [](auto& material) -> auto& { return material.alpha; });
        form_.number(
            words("opacity", QObject::tr("Opacity"), QObject::tr("Works while it is see-through")),
            {Quantity::share, 0.0, 1.0, 1.0}, part_, [](auto& material) -> auto& { return material.opacity; });
        texture("hole", QObject::tr("Picture of holes"),
                memberOf<SceneTexture>(
                    part_, [](auto& material) -> auto& { return material.holes; }));
        form_.number(
            words("threshold", QObject::tr("Cut below"), QObject::tr("What is darker than this is cut out")),
            {Quantity::share, 0.0, 1.0, 0.5}, part_, [](auto& material) -> auto& { return material.holeThreshold; });
    }

    void addGlow() {
        section("glow", QObject::tr("Glow"), false);
        form_.color(
            words("emission", QObject::tr("Glow colour")), part_,
            [](auto& material) -> auto& { return material.emission; });
        form_.number(
            words("emissionStrength", QObject::tr("Brightness"), QObject::tr("1 is as bright as white")),
            {Quantity::plain, 0.0, 50.0, 1.0}, part_,
            [](auto& material) -> auto& { return material.emissionStrength; });
    }

    SceneForm& form_;
    Studio& studio_;
    QString prefix_;
    Part<Material> part_;
    std::function<bool(const StudioState&)> metres_;
    std::function<bool(const StudioState&)> shown_;
};

} // namespace

void addMaterialRows(SceneForm& form, Studio& studio, const QString& prefix, const Part<Material>& part,
                     const std::function<bool(const StudioState&)>& metres,
                     const std::function<bool(const StudioState&)>& shown) {
    MaterialRows(form, studio, prefix, part, metres, shown).addAll();
}

} // namespace lumorph::studio
