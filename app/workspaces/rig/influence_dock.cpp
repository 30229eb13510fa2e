#include <algorithm>
#include <array>
#include <utility>

#include <QButtonGroup>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "app/studio/document/job_slots.h"
#include "app/studio/document/rig_edit.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/common/field_summary.h"
#include "app/workspaces/rig/actuator_guide.h"
#include "app/workspaces/rig/rig_docks.h"

namespace lumorph::studio {

namespace {

using Tool = InfluenceTools::Tool;

/// What weights are to the way in which an actuator moves.
struct WeightMeaning {
    QString operator()(const Hinge&) const { return "A place that follows by half turns by half the angle."; }
    QString operator()(const Bend&) const {
        return "A place that follows by half bends by half the angle. What lies on the near side of the bend line "
               "never "
               "moves, however much it follows.";
    }
    QString operator()(const Slide&) const { return "A place that follows by half goes half the way."; }
    QString operator()(const MorphTarget&) const {
        return "A morph target moves only what its shape moves: nothing else can follow it, and what follows it less "
               "stops earlier on its way.";
    }
    QString operator()(const SkinJoint&) const {
        return "A joint shares the skin with the others: what it takes of a place they give, and what it leaves they "
               "take. A joint that hangs on none keeps what is its alone.";
    }
    QString operator()(const SheetLift&) const {
        return "What follows a lever is computed from the sheet's mechanics: it cannot be painted.";
    }
};

class RigInfluence : public QWidget {
public:
    RigInfluence(Studio& studio, RigSelection& selection, InfluenceTools& tools)
        : studio_(studio), selection_(selection), tools_(tools), slots_(*this, studio.jobs, studio.notices),
          what_(new QLabel), group_(new QButtonGroup(this)) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        layout->addWidget(makeJobBar(studio.jobs, "rig.influence"));
        const Column column = makeColumn();
        layout->addWidget(column.widget, 1);
        what_->setObjectName("rig.influence.what");
        what_->setWordWrap(true);
        what_->setProperty("look", "muted");
        column.layout->addWidget(what_);
        edit_ = makeCommandButton(studio.commands.find("rig.paint"), "rig.influence.edit", nullptr, true);
        column.layout->addWidget(edit_);
        form_ = makeForm();
        column.layout->addWidget(form_);
        column.layout->addStretch(1);
        connect(&tools_, &InfluenceTools::changed, this, [this] { refresh(); });
        connect(&tools_, &InfluenceTools::placePicked, this, [this](const glm::vec3& place) { spreadFrom(place); });
        connect(&selection_, &RigSelection::changed, this, [this] { refresh(); });
        connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
            if ((parts & (StatePart::rig | StatePart::rigEdited)) && !studio_.document.previewing()) refresh();
        });
        refresh();
    }

private:
    QWidget* makeForm() {
        auto* form = new QWidget;
        auto* layout = new QVBoxLayout(form);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        layout->addWidget(makeHeading("Tool"));
        auto* row = new QHBoxLayout;
        row->setSpacing(4);
        struct Choice {
            Tool tool;
            QString text, name, hint;
        };
        const std::array<Choice, 4> choices{
            Choice{Tool::paint, "Paint", "paint", "Drawn over, a place follows more"},
            Choice{Tool::erase, "Erase", "erase", "Drawn over, a place follows less"},
            Choice{Tool::smooth, "Smooth", "smooth", "Drawn over, a place follows as those around it do"},
            Choice{Tool::distance, "Distance", "distance",
                   "Sets all at once, by the distance along the surface from a place or from the line"}};
        for (const Choice& choice : choices) {
            auto* button = new QPushButton(choice.text);
            button->setObjectName("rig.influence." + choice.name);
            button->setToolTip(choice.hint);
            button->setCheckable(true);
            button->setMinimumWidth(1);
            group_->addButton(button, static_cast<int>(choice.tool));
            row->addWidget(button);
        }
        layout->addLayout(row);
        connect(group_, &QButtonGroup::idClicked, this, [this](int id) { tools_.setTool(static_cast<Tool>(id)); });
        addField(layout, {"radius", "&Radius", "Of the brush"}, Quantity::length, 0.001, 0.2, tools_.brush().radius,
                 brushRows_, [this](double value) { tools_.setRadius(value); });
        addField(layout, {"strength", "&Strength", "What one dab of the brush does in its middle"}, Quantity::share,
                 0.01, 1.0, tools_.brush().strength, brushRows_, [this](double value) { tools_.setStrength(value); });
        addField(layout, {"full", "&Fully up to", "Up to this distance along the surface all follows"},
                 Quantity::length, 0.0, 1.0, tools_.falloff().full, distanceRows_, [this](double value) {
                     tools_.setFalloff({value, tools_.falloff().range});
                 });
        addField(layout, {"range", "F&alls off over", "From there to nothing, smoothly"}, Quantity::length, 0.0, 1.0,
                 tools_.falloff().range, distanceRows_, [this](double value) {
                     tools_.setFalloff({tools_.falloff().full, value});
                 });
        hint_ = new QLabel("Click a place of the device, or take the line that it turns about. A sheet of up to 6 mm "
                           "follows on both its sides.");
        hint_->setWordWrap(true);
        hint_->setProperty("look", "muted");
        line_ = new QPushButton("From its line");
        line_->setObjectName("rig.influence.line");
        connect(line_, &QPushButton::clicked, this, [this] { spreadFromLine(); });
        layout->addWidget(hint_);
        layout->addWidget(line_);
        return form;
    }

    struct Words {
        QString name, label, hint;
    };
    void addField(QVBoxLayout* layout, const Words& words, Quantity quantity, double low, double high, double usual,
                  std::vector<QWidget*>& rows, const std::function<void(double)>& set) {
        auto* field = new ValueField(quantity, low, high, usual);
        field->setObjectName("rig.influence." + words.name);
        field->setToolTip(words.hint + ".\n" + field->toolTip());
        field->setValue(usual);
        connect(field, &ValueField::previewed, this, set);
        connect(field, &ValueField::committed, this, set);
        connect(field, &ValueField::reverted, this, [field, set] { set(field->value()); });
        rows.push_back(makeRow(words.label, field));
        layout->addWidget(rows.back());
    }

    [[nodiscard]] const Actuator* chosen() const {
        const auto& parts = studio_.document.state().rig.parts;
        const auto index = selection_.actuator();
        return parts && index && *index < parts->actuators.size() ? &parts->actuators[*index] : nullptr;
    }

    void refresh() {
        const Actuator* actuator = chosen();
        const bool paintable = actuator && !std::holds_alternative<SheetLift>(actuator->deformer);
        edit_->setVisible(paintable);
        form_->setVisible(paintable && tools_.editing());
        if (!actuator) return what_->setText("Choose an actuator to say which places of the device follow it.");
        const auto& parts = *studio_.document.state().rig.parts;
        const auto weights = actuatorWeights(parts, *selection_.actuator());
        const auto follow = static_cast<std::size_t>(std::ranges::count_if(weights, [](float w) { return w > 0.0F; }));
        what_->setText(QString("%1 of %2 vertices follow %3. ")
                           .arg(countText(follow), countText(weights.size()), QString::fromStdString(actuator->name)) +
                       std::visit(WeightMeaning(), actuator->deformer));
        group_->button(static_cast<int>(tools_.tool()))->setChecked(true);
        const bool distance = tools_.tool() == Tool::distance;
        for (QWidget* row : brushRows_) row->setVisible(!distance);
        for (QWidget* row : distanceRows_) row->setVisible(distance);
        hint_->setVisible(distance);
        line_->setVisible(distance);
        const auto guide = guideNow();
        line_->setEnabled(guide && guide->hasLine);
        line_->setToolTip(!guide           ? "It moves nothing yet: paint, or click a place"
                          : guide->hasLine ? "From the bend line or axis, to the side of its part"
                                           : "It does not turn about a line of its own: click a place");
    }

    [[nodiscard]] std::optional<ActuatorGuide> guideNow() const {
        const auto& asset = studio_.document.state().rig;
        if (!chosen() || !asset.rig || *selection_.actuator() >= asset.rig->actuatorCount()) return std::nullopt;
        return guideOf(*asset.parts, *selection_.actuator(), asset.rig->verticesOf(*selection_.actuator()));
    }

    void spreadFrom(const glm::vec3& place) {
        spread([place](const TriangleMesh& mesh, const WeightFalloff& falloff, const Progress& progress) {
            return weightsAround(mesh, place, falloff, progress);
        });
    }
    void spreadFromLine() {
        const auto guide = guideNow();
        if (!guide || !guide->hasLine) return;
        spread([ends = endsOf(*guide), side = guide->arm](const TriangleMesh& mesh, const WeightFalloff& falloff,
                                                          const Progress& progress) {
            return weightsBeside(mesh, ends, side, falloff, progress);
        });
    }

    using Spread = std::function<std::vector<float>(const TriangleMesh&, const WeightFalloff&, const Progress&)>;
    void spread(const Spread& weigh) {
        const Actuator* actuator = chosen();
        if (!actuator) return;
        const auto parts = studio_.document.state().rig.parts;
        slots_.run<std::vector<float>>(
            "spread", "rig.influence", "Measuring along the surface",
            [parts, weigh, falloff = tools_.falloff()](const Progress& progress) {
                return weigh(parts->restMesh, falloff, progress);
            },
            [this, parts, index = *selection_.actuator()](const std::vector<float>& weights) {
                take(*parts, index, weights);
            });
    }
    /// Unless the rig has become another one meanwhile.
    void take(const RigParts& of, std::size_t index, const std::vector<float>& weights) {
        const auto& now = studio_.document.state().rig.parts;
        if (!now || index >= now->actuators.size() || now->actuators[index].name != of.actuators[index].name ||
            now->restMesh != of.restMesh || studio_.document.previewing())
            return;
        editRig(studio_.document,
                QString("Set the influence of %1 by distance").arg(QString::fromStdString(of.actuators[index].name)),
                [&](RigParts& parts) { setActuatorWeights(parts, index, weights); });
    }

    Studio& studio_;
    RigSelection& selection_;
    InfluenceTools& tools_;
    JobSlots slots_;
    QLabel* what_;
    QButtonGroup* group_;
    QPushButton* edit_ = nullptr;
    QWidget* form_ = nullptr;
    QLabel* hint_ = nullptr;
    QPushButton* line_ = nullptr;
    std::vector<QWidget*> brushRows_, distanceRows_;
};

} // namespace

QWidget* makeRigInfluence(Studio& studio, RigSelection& selection, InfluenceTools& tools) {
    return new RigInfluence(studio, selection, tools);
}

} // namespace lumorph::studio
