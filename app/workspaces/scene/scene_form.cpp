#include "app/workspaces/scene/scene_form.h"

#include <algorithm>
#include <utility>

#include <QGridLayout>
#include <QLabel>
#include <QSignalBlocker>

#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/scene/color_field.h"

namespace lumorph::studio {

namespace {

QString editName(const FormWords& words) { return QObject::tr("Change %1").arg(words.label.toLower().remove('&')); }

} // namespace

QColor toColor(const glm::vec3& color) {
    const auto held = [](float channel) { return std::clamp(channel, 0.0F, 1.0F); };
    return QColor::fromRgbF(held(color.x), held(color.y), held(color.z));
}

glm::vec3 fromColor(const QColor& color) { return {color.redF(), color.greenF(), color.blueF()}; }

SceneForm::SceneForm(StudioDocument& document, QWidget* parent)
    : QWidget(parent), document_(document), column_(new QVBoxLayout(this)), rows_(column_) {
    column_->setContentsMargins(0, 0, 0, 0);
    column_->setSpacing(6);
}

CollapsibleSection& SceneForm::section(const QString& name, const QString& title, bool open) {
    auto* section = new CollapsibleSection(name, title, open, this);
    column_->addWidget(section);
    rows_ = &section->rows();
    return *section;
}

void SceneForm::endSection() { rows_ = column_; }

void SceneForm::add(QWidget* widget) { rows_->addWidget(widget); }

QLabel* SceneForm::sentence(const QString& name, const QString& text) {
    auto* label = new QLabel(text, this);
    label->setObjectName(name);
    label->setProperty("look", "muted");
    label->setTextFormat(Qt::PlainText);
    label->setWordWrap(true);
    add(label);
    return label;
}

void SceneForm::showWhile(QWidget* widget, std::function<bool(const StudioState&)> holds) {
    onRefresh([widget, holds = std::move(holds)](const StudioState& state) { widget->setVisible(holds(state)); });
}

void SceneForm::onRefresh(std::function<void(const StudioState&)> run) { refreshes_.push_back(std::move(run)); }

void SceneForm::refresh() {
    const StudioState shown = document_.state(); // what a row sets off may change the document
    for (const auto& refresh : refreshes_) refresh(shown);
}

/// What was refused is shown as it still is.
void SceneForm::edit(const QString& what, const StateEdit& edit) {
    document_.change(what, edit);
    refresh();
}

QWidget* SceneForm::makeNumber(const NumberRow& row) {
    auto* field = new ValueField(row.range.quantity, row.range.low, row.range.high, row.range.reset, this);
    field->setObjectName(row.words.name);
    field->setAccessibleName(row.words.label);
    if (row.range.step > 0.0) field->setStep(row.range.step);
    if (!row.words.hint.isEmpty()) field->setToolTip(row.words.hint);
    const auto change = [write = row.write](double value) {
        return [write, value](StudioState& state) { write(state, value); };
    };
    connect(field, &ValueField::previewed, this, [this, change](double value) { document_.preview(change(value)); });
    connect(field, &ValueField::committed, this, [this, change, what = editName(row.words)](double value) {
        document_.preview(change(value));
        document_.commitPreview(what);
        refresh();
    });
    connect(field, &ValueField::reverted, this, [this] { document_.cancelPreview(); });
    onRefresh([field, read = row.read](const StudioState& state) {
        if (const auto value = read(state)) field->setValue(*value);
    });
    return field;
}

QWidget* SceneForm::addNumbers(const QString& label, const std::vector<NumberRow>& rows) {
    if (rows.size() == 1) {
        QWidget* row = makeRow(label, makeNumber(rows.front()), this);
        add(row);
        return row;
    }
    auto* block = new QWidget(this);
    auto* grid = new QGridLayout(block);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setHorizontalSpacing(8);
    grid->setVerticalSpacing(2);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const int column = static_cast<int>(i);
        // The first carries the name of all, the others their letter.
        auto* name = new QLabel(i == 0 ? rows[i].words.label : rows[i].words.label.section(' ', -1), block);
        name->setProperty("look", "muted");
        QWidget* field = makeNumber(rows[i]);
        name->setBuddy(field);
        grid->addWidget(name, 0, column);
        grid->addWidget(field, 1, column);
        grid->setColumnStretch(column, 1);
        grid->setColumnMinimumWidth(column, 72);
    }
    add(block);
    return block;
}

QCheckBox* SceneForm::addCheck(const FormWords& words, ReadBool read, std::function<void(StudioState&, bool)> write) {
    auto* box = new QCheckBox(words.label, this);
    box->setObjectName(words.name);
    box->setToolTip(words.hint);
    connect(box, &QCheckBox::clicked, this, [this, write = std::move(write), what = editName(words)](bool on) {
        edit(what, [&](StudioState& state) { write(state, on); });
    });
    onRefresh([box, read = std::move(read)](const StudioState& state) {
        if (const auto on = read(state)) box->setChecked(*on);
    });
    add(box);
    return box;
}

QWidget* SceneForm::addColor(const FormWords& words, ReadColor read,
                             std::function<void(StudioState&, const glm::vec3&)> write) {
    auto* field = new ColorField(this);
    field->setObjectName(words.name);
    field->setAccessibleName(words.label);
    field->setToolTip(words.hint.isEmpty() ? tr("Choose another colour") : words.hint);
    const auto change = [write = std::move(write)](const QColor& color) {
        return [write, value = fromColor(color)](StudioState& state) { write(state, value); };
    };
    connect(field, &ColorField::previewed, this,
            [this, change](const QColor& color) { document_.preview(change(color)); });
    connect(field, &ColorField::committed, this, [this, change, what = editName(words)](const QColor& color) {
        document_.preview(change(color));
        document_.commitPreview(what);
        refresh();
    });
    connect(field, &ColorField::reverted, this, [this] {
        document_.cancelPreview();
        refresh();
    });
    onRefresh([field, read = std::move(read)](const StudioState& state) {
        if (const auto color = read(state)) field->setColor(toColor(*color));
    });
    QWidget* row = makeRow(words.label, field, this);
    add(row);
    return row;
}

Segments* SceneForm::addSegments(const FormWords& words, const std::vector<Segments::Segment>& choices, ReadIndex read,
                                 const WriteIndex& write) {
    auto* segments = new Segments(choices, this);
    segments->setObjectName(words.name);
    segments->setAccessibleName(words.label);
    connect(segments, &Segments::chosen, this, [this, write, what = editName(words)](int index) {
        edit(what, [&](StudioState& state) { write(state, index); });
    });
    onRefresh([segments, read = std::move(read)](const StudioState& state) {
        if (const auto index = read(state)) segments->setChosen(*index);
    });
    add(segments);
    return segments;
}

QComboBox* SceneForm::addChoice(const FormWords& words, const QStringList& names, ReadIndex read,
                                const WriteIndex& write) {
    auto* box = new QComboBox(this);
    box->setObjectName(words.name);
    box->setAccessibleName(words.label);
    box->setToolTip(words.hint);
    box->addItems(names);
    box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    box->setMinimumContentsLength(8);
    connect(box, &QComboBox::activated, this, [this, write, what = editName(words)](int index) {
        edit(what, [&](StudioState& state) { write(state, index); });
    });
    onRefresh([box, read = std::move(read)](const StudioState& state) {
        const QSignalBlocker quiet(box);
        if (const auto index = read(state)) box->setCurrentIndex(*index);
    });
    add(makeRow(words.label, box, this));
    return box;
}

} // namespace lumorph::studio
