#include "app/workspaces/rig/sheet_form.h"

#include <algorithm>

#include <QButtonGroup>
#include <QHBoxLayout>

#include "app/studio/look/icons.h"
#include "app/studio/widgets/panel.h"
#include "core/rig/sheet/sheet_material.h"
#include "core/rig/templates/sheet_drawing.h"
#include "core/rig/templates/sheet_outline.h"

namespace lumorph::studio {

namespace {

constexpr int kLongestName = 40;

QVBoxLayout* makeColumnOf(QWidget* page) {
    auto* column = new QVBoxLayout(page);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(4);
    return column;
}

} // namespace

SheetForm::SheetForm(QWidget* parent) : QStackedWidget(parent) {
    addWidget(makeSheet());
    addWidget(makeLine());
}

QWidget* SheetForm::makeSheet() {
    auto* page = new QWidget;
    QVBoxLayout& column = *makeColumnOf(page);
    column.addWidget(makeHeading(tr("Sheet")));
    name_ = addName(column, "sheet.name", tr("What the device is called"));
    top_ = new Segments({{"sheet.top.cut", tr("Cut into flaps"), tr("Slits part each flap from the rest")},
                         {"sheet.top.continuous", tr("Left joined"),
                          tr("One elastic sheet without slits, lifted by a lever for each bend line: its shape follows "
                             "from mechanics")}});
    column.addWidget(makeRow(tr("Top"), top_));
    connect(top_, &Segments::chosen, this, [this](int top) {
        change(top == 0 ? tr("Cut the top") : tr("Leave the top joined"),
               [top](SheetDevice& device) { device.top = static_cast<SheetTop>(top); });
    });
    material_ = new QComboBox;
    material_->setObjectName("sheet.material");
    material_->setToolTip(tr("Of the flexible sheet: stiffer ones need stronger servos"));
    for (const SheetMaterial& material : sheetMaterials())
        material_->addItem(QString::fromStdString(std::string(material.name)));
    materialRow_ = makeRow(tr("&Material"), material_);
    column.addWidget(materialRow_);
    connect(material_, &QComboBox::activated, this, [this] {
        change(tr("Change the material"),
               [name = material_->currentText().toStdString()](SheetDevice& device) { device.material = name; });
    });
    const auto sizeOf = [](const SheetDevice& device) { return boxOf(device.outline).size(); };
    width_ = addField(
        column,
        {"sheet.width", tr("&Width"), tr("Of the outline; bend lines are stretched with it"), tr("Change the width")},
        {Quantity::length, 0.02, 2.0, 0.21},
        [sizeOf](SheetDevice& device, double value) { device = withSize(device, value, sizeOf(device).y); });
    depth_ = addField(
        column,
        {"sheet.depth", tr("&Depth"), tr("Of the outline; bend lines are stretched with it"), tr("Change the depth")},
        {Quantity::length, 0.02, 2.0, 0.15},
        [sizeOf](SheetDevice& device, double value) { device = withSize(device, sizeOf(device).x, value); });
    thickness_ = addField(
        column, {"sheet.thickness", tr("&Thickness"), tr("Of the flexible sheet"), tr("Change the thickness")},
        {Quantity::length, 0.0002, 0.02, 0.002}, [](SheetDevice& device, double value) { device.thickness = value; });
    housing_ = addField(column,
                        {"sheet.housing", tr("&Housing"), tr("Height of the box below, which holds the servos"),
                         tr("Change the housing")},
                        {Quantity::length, 0.001, 0.5, 0.016},
                        [](SheetDevice& device, double value) { device.housing = value; });
    arc_ =
        addField(column,
                 {"sheet.arc", tr("&Arc"), tr("Length of sheet that a bend curves: longer bends more gently"),
                  tr("Change the arc")},
                 {Quantity::length, 0.002, 0.2, 0.02}, [](SheetDevice& device, double value) { device.arc = value; });
    arcRow_ = arc_->parentWidget();
    for (ValueField* field : {thickness_, housing_, arc_}) field->setStep(0.0005);
    column.addStretch(1);
    return page;
}

QWidget* SheetForm::makeLine() {
    auto* page = new QWidget;
    QVBoxLayout& column = *makeColumnOf(page);
    column.addWidget(makeHeading(tr("Bend line")));
    lineName_ = addName(column, "sheet.line.name", tr("What the flap is called; each has a name of its own"));
    angle_ = addField(
        column,
        {"sheet.line.angle", tr("&Angle"), tr("How far the flap bends up at full stroke"), tr("Change the angle")},
        {Quantity::angle, Angle::degrees(5.0).inRadians(), Angle::degrees(90.0).inRadians(),
         Angle::degrees(90.0).inRadians()},
        [this](SheetDevice& device, double value) {
            if (BendLine* line = lineOf(device)) line->angle = Angle::radians(value);
        });
    auto* ends = new QWidget;
    auto* row = new QHBoxLayout(ends);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(4);
    auto* group = new QButtonGroup(ends);
    joined_ = new QPushButton(tr("Joined"));
    joined_->setObjectName("sheet.line.joined");
    joined_->setToolTip(tr("The bend runs on to the sheet's edges: nothing is cut where it gets there"));
    free_ = new QPushButton(tr("Cut free"));
    free_->setObjectName("sheet.line.free");
    free_->setToolTip(tr("The flap is as wide as the line: slits cut it free at both ends"));
    for (QPushButton* button : {joined_, free_}) {
        button->setCheckable(true);
        button->setAutoDefault(false);
        button->setProperty("look", "segment");
        group->addButton(button);
        row->addWidget(button, 1);
    }
    connect(joined_, &QPushButton::clicked, this, [this] { setEnds(BendLine::Ends::joined); });
    connect(free_, &QPushButton::clicked, this, [this] { setEnds(BendLine::Ends::free); });
    endsRow_ = makeRow(tr("Ends"), ends);
    column.addWidget(endsRow_);
    auto* buttons = new QHBoxLayout;
    buttons->setSpacing(4);
    auto* side = new QPushButton(icon("flip-side"), tr("Move the other side"));
    side->setObjectName("sheet.line.side");
    side->setToolTip(tr("The part of the sheet beyond the line moves, and this one stays"));
    side->setAutoDefault(false);
    auto* remove = new QPushButton(icon("trash"), tr("Delete"));
    remove->setObjectName("sheet.line.delete");
    remove->setToolTip(tr("Takes this bend line away (Delete)"));
    remove->setAutoDefault(false);
    buttons->addWidget(side, 1);
    buttons->addWidget(remove);
    column.addSpacing(4);
    column.addLayout(buttons);
    connect(side, &QPushButton::clicked, this, &SheetForm::otherSideWanted);
    connect(remove, &QPushButton::clicked, this, &SheetForm::removeWanted);
    column.addStretch(1);
    return page;
}

QLineEdit* SheetForm::addName(QVBoxLayout& column, const char* name, const QString& hint) {
    auto* field = new QLineEdit;
    field->setObjectName(name);
    field->setToolTip(hint);
    field->setMaxLength(kLongestName);
    column.addWidget(makeRow(tr("&Name"), field));
    connect(field, &QLineEdit::editingFinished, this, &SheetForm::rename);
    return field;
}

ValueField* SheetForm::addField(QVBoxLayout& column, const Words& words, const Limits& limits, const Edit& edit) {
    auto* field = new ValueField(limits.quantity, limits.low, limits.high, limits.reset);
    field->setObjectName(words.name);
    field->setToolTip(words.hint + ".\n" + field->toolTip());
    column.addWidget(makeRow(words.label, field));
    const auto made = [this, edit](double value) {
        SheetDevice device = device_;
        edit(device, value);
        return device;
    };
    connect(field, &ValueField::previewed, this, [this, made](double value) { emit previewed(made(value)); });
    connect(field, &ValueField::committed, this,
            [this, made, step = words.step](double value) { emit edited(made(value), step); });
    connect(field, &ValueField::reverted, this, &SheetForm::reverted);
    return field;
}

BendLine* SheetForm::lineOf(SheetDevice& device) const {
    return line_ && *line_ < device.bends.size() ? &device.bends[*line_] : nullptr;
}

void SheetForm::show(const SheetDevice& device, std::optional<std::size_t> line) {
    const bool other = line != line_;
    device_ = device;
    line_ = line;
    const auto tell = [other](QLineEdit* field, const std::string& name) {
        if (other || !(field->hasFocus() && field->isModified())) field->setText(QString::fromStdString(name));
    };
    tell(name_, device.name);
    const glm::dvec2 size = boxOf(device.outline).size();
    width_->setEnabled(!device.outline.empty());
    depth_->setEnabled(!device.outline.empty());
    width_->setValue(size.x);
    depth_->setValue(size.y);
    thickness_->setValue(device.thickness);
    housing_->setValue(device.housing);
    arc_->setValue(device.arc);
    const bool joined = device.top == SheetTop::continuous;
    top_->setChosen(static_cast<int>(device.top));
    material_->setCurrentText(QString::fromStdString(device.material));
    materialRow_->setVisible(joined);
    for (QWidget* row : {arcRow_, endsRow_}) row->setVisible(!joined);
    const BendLine* bend = lineOf(device_);
    setCurrentIndex(bend != nullptr ? 1 : 0);
    if (bend == nullptr) return;
    tell(lineName_, bend->name);
    angle_->setValue(bend->angle.inRadians());
    (bend->ends == BendLine::Ends::joined ? joined_ : free_)->setChecked(true);
}

void SheetForm::change(const QString& step, const std::function<void(SheetDevice&)>& edit) {
    SheetDevice device = device_;
    edit(device);
    if (device != device_) emit edited(device, step);
    show(device_, line_);
}

void SheetForm::rename() {
    for (QLineEdit* field : {name_, lineName_}) {
        if (!field->isModified()) continue;
        field->setModified(false);
        const std::string name = field->text().trimmed().toStdString();
        if (name.empty()) continue;
        change(tr("Rename to %1").arg(field->text().trimmed()), [&](SheetDevice& device) {
            if (field == name_)
                device.name = name;
            else if (BendLine* line = lineOf(device))
                line->name = name;
        });
    }
    show(device_, line_);
}

void SheetForm::setEnds(BendLine::Ends ends) {
    change(ends == BendLine::Ends::free ? tr("Cut the ends free") : tr("Join the ends"), [&](SheetDevice& device) {
        if (BendLine* line = lineOf(device)) line->ends = ends;
    });
}

} // namespace lumorph::studio
