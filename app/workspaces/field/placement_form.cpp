#include "app/workspaces/field/placement_form.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <QGridLayout>
#include <QLabel>

#include "app/studio/widgets/value_field.h"

namespace lumorph::studio {

namespace {

constexpr double kFarthest = 10.0; ///< metres
constexpr int kColumns = 3;
constexpr double kTurn = 2.0 * std::numbers::pi;

class PlacementForm : public QWidget {
public:
    PlacementForm(StudioDocument& document, QWidget* parent) : QWidget(parent), document_(document) {
        grid_->setContentsMargins(0, 0, 0, 0);
        grid_->setHorizontalSpacing(8);
        grid_->setVerticalSpacing(4);
        for (int column = 0; column < kColumns; ++column) grid_->setColumnStretch(column, 1);
        addLength("x", "&X", "To the right of the device's middle", 0);
        addLength("y", "&Y", "Above the table", 1);
        addLength("z", "&Z", "Towards the front of the device", 2);
        add(
            {"turn", "T&urn", "Heading about the upright axis"}, Quantity::angle, -kTurn, kTurn, 0.0,
            std::numbers::pi / 180.0, [](const Placement& placement) { return placement.yaw.inRadians(); },
            [](Placement& placement, double value) { placement.yaw = Angle::radians(value); });
        addTip("tip", "T&ip", "Forwards, about the axis from left to right", 0);
        addTip("roll", "&Roll", "Sideways, about the axis from back to front", 2);
        add(
            {"size", "Si&ze", "The target's longest side"}, Quantity::length, 1e-4, kFarthest, 0.1, 0.001,
            [this](const Placement& placement) { return placement.scale * longestSide(); },
            [this](Placement& placement, double value) { placement.scale = value / longestSide(); });
        connect(&document, &StudioDocument::changed, this, [this](StateParts parts) {
            if (parts & (StatePart::placement | StatePart::target)) refresh();
        });
        refresh();
    }

private:
    using Get = std::function<double(const Placement&)>;
    using Set = std::function<void(Placement&, double)>;
    struct Words {
        QString name, label, hint;
    };
    struct Line {
        ValueField* field = nullptr;
        Get get;
    };

    /// Metres, as its file says; 1 without a target.
    [[nodiscard]] double longestSide() const {
        const auto& target = document_.state().target.target;
        if (!target) return 1.0;
        const glm::vec3 size = target->box.size();
        return std::max(1e-9, static_cast<double>(std::max({size.x, size.y, size.z})));
    }

    void addLength(const QString& name, const QString& label, const QString& hint, int axis) {
        add(
            {name, label, hint}, Quantity::length, -kFarthest, kFarthest, 0.0, 0.001,
            [axis](const Placement& placement) { return static_cast<double>(placement.translation[axis]); },
            [axis](Placement& placement, double value) { placement.translation[axis] = static_cast<float>(value); });
    }

    /// Which side of the target is up: its orientation as turns about z, then x, then the upright axis.
    void addTip(const QString& name, const QString& label, const QString& hint, int axis) {
        const auto anglesOf = [](const Placement& placement) {
            const glm::mat3 m = glm::mat3_cast(placement.orientation);
            const float tip = std::asin(std::clamp(-m[2][1], -1.0F, 1.0F));
            return glm::dvec3(tip, std::atan2(m[2][0], m[2][2]), std::atan2(m[0][1], m[1][1]));
        };
        add(
            {name, label, hint}, Quantity::angle, -kTurn, kTurn, 0.0, std::numbers::pi / 180.0,
            [anglesOf, axis](const Placement& placement) { return anglesOf(placement)[axis]; },
            [anglesOf, axis](Placement& placement, double value) {
                glm::dvec3 angles = anglesOf(placement);
                angles[axis] = value;
                placement.orientation = glm::quat(glm::angleAxis(angles.y, glm::dvec3(0, 1, 0)) *
                                                  glm::angleAxis(angles.x, glm::dvec3(1, 0, 0)) *
                                                  glm::angleAxis(angles.z, glm::dvec3(0, 0, 1)));
            });
    }

    void add(const Words& words, Quantity quantity, double low, double high, double reset, double step, Get get,
             const Set& set) {
        auto* field = new ValueField(quantity, low, high, reset, this);
        field->setObjectName("target." + words.name);
        field->setToolTip(words.hint + ". Type a value, or drag sideways.");
        field->setStep(step);
        const auto edit = [set](double value) {
            return [set, value](StudioState& state) { set(state.placement, value); };
        };
        connect(field, &ValueField::previewed, this, [this, edit](double value) { document_.preview(edit(value)); });
        connect(field, &ValueField::committed, this, [this, edit](double value) {
            document_.preview(edit(value));
            document_.commitPreview("Place the target");
        });
        connect(field, &ValueField::reverted, this, [this] { document_.cancelPreview(); });
        auto* label = new QLabel(words.label, this);
        label->setProperty("look", "muted");
        label->setBuddy(field);
        field->setAccessibleName(QString(words.label).remove('&'));
        field->setMinimumWidth(0);
        const int cell = static_cast<int>(lines_.size());
        grid_->addWidget(label, 2 * (cell / kColumns), cell % kColumns);
        grid_->addWidget(field, 2 * (cell / kColumns) + 1, cell % kColumns);
        lines_.push_back({field, std::move(get)});
    }

    void refresh() {
        for (const Line& line : lines_) line.field->setValue(line.get(document_.state().placement));
    }

    StudioDocument& document_;
    QGridLayout* grid_ = new QGridLayout(this);
    std::vector<Line> lines_;
};

} // namespace

QWidget* makePlacementForm(StudioDocument& document, QWidget* parent) { return new PlacementForm(document, parent); }

} // namespace lumorph::studio
