#include "app/workspaces/field/field_build.h"

#include <array>
#include <cmath>

#include <QComboBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QKeyEvent>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/common/field_summary.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

constexpr int kMaxResolution = 4096;
constexpr int kMaxSamples = 65535;
constexpr double kMaxSeed = 9'007'199'254'740'992.0; // a double holds whole numbers up to here

/// Usual ways to build, by name.
struct Preset {
    const char* text;
    int resolution, levels, samples;
};
constexpr std::array kPresets{Preset{"A quick look", 17, 17, 16}, Preset{"Usual", 33, 33, 64},
                              Preset{"Fine", 49, 49, 96}, Preset{"Very fine", 65, 65, 128}};

/// A whole number with its limits, and a line below for what is wrong with it.
struct Entry {
    ValueField* field = nullptr;
    QLabel* wrong = nullptr;
    QString name;
    double low = 0.0, high = 0.0;

    /// What is wrong with the text as it stands; empty when it is fine.
    [[nodiscard]] QString fault() const {
        if (!field->isModified()) return {}; // scrubbed, not typed: always in range, and rounded at the end
        const auto value = parseQuantity(field->text(), Quantity::level);
        if (!value || *value != std::floor(*value)) return QObject::tr("%1 is a whole number.").arg(name);
        if (*value >= low && *value <= high) return {};
        return QObject::tr("Choose a number from %1 to %2.").arg(low, 0, 'f', 0).arg(high, 0, 'f', 0);
    }
};

class BuildDialog : public QDialog {
public:
    BuildDialog(Studio& studio, QWidget* parent);

private:
    /// Enter on a number that is refused must neither correct it silently nor build.
    bool eventFilter(QObject* watched, QEvent* event) override;
    Entry addEntry(QVBoxLayout& layout, const QString& id, const QString& label, const QString& name,
                   const QString& hint, double low, double high, double value);
    void addButtons(QVBoxLayout& layout);
    void start();
    void check();
    void showEstimate();
    void applyPreset(int index);
    [[nodiscard]] BuildOptions options() const;

    Studio& studio_;
    QComboBox* presets_;
    Entry resolution_, levels_, samples_, seed_;
    QLabel* estimate_;
    QPushButton* build_ = nullptr;
};

BuildDialog::BuildDialog(Studio& studio, QWidget* parent)
    : QDialog(parent), studio_(studio), presets_(new QComboBox), estimate_(new QLabel) {
    setObjectName("field.build.dialog");
    setAttribute(Qt::WA_DeleteOnClose);
    setWindowTitle(tr("Build the field"));
    setMinimumWidth(400);
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(16, 16, 16, 16);
    layout->setSpacing(8);
    auto* what = new QLabel(tr("The field says what space each actuator fills at each level. It is built once for a "
                               "device; matching then takes a fraction of a millisecond."));
    what->setWordWrap(true);
    what->setProperty("look", "muted");
    layout->addWidget(what);
    presets_->setObjectName("field.build.preset");
    for (const Preset& preset : kPresets) presets_->addItem(tr(preset.text));
    presets_->addItem(tr("My own numbers"));
    layout->addWidget(makeRow(tr("&How fine"), presets_));
    resolution_ = addEntry(*layout, "field.build.resolution", tr("&Resolution"), tr("The resolution"),
                           tr("Voxels along the shortest side of the space"), 2, kMaxResolution, 33);
    levels_ = addEntry(*layout, "field.build.levels", tr("&Levels"), tr("The number of levels"),
                       tr("Steps from rest to full stroke"), 2, kMaxLevels, 33);
    samples_ =
        addEntry(*layout, "field.build.samples", tr("&Samples"), tr("The number of samples"),
                 tr("States of the other actuators to average over; more give smoother ramps"), 1, kMaxSamples, 64);
    seed_ = addEntry(*layout, "field.build.seed", tr("S&eed"), tr("The seed"),
                     tr("Which states are drawn; the same seed gives the same field"), 0, kMaxSeed, 1);
    estimate_->setObjectName("field.build.estimate");
    estimate_->setWordWrap(true);
    layout->addSpacing(8);
    layout->addWidget(estimate_);
    layout->addStretch(1);
    addButtons(*layout);
    if (const auto& field = studio.document.state().field.field) {
        resolution_.field->setValue(std::min(
            {field->field.frame.dimensions.x, field->field.frame.dimensions.y, field->field.frame.dimensions.z}));
        levels_.field->setValue(field->field.levels);
        samples_.field->setValue(field->field.samples);
        seed_.field->setValue(static_cast<double>(field->field.seed));
    }
    connect(presets_, &QComboBox::activated, this, &BuildDialog::applyPreset);
    check();
    resolution_.field->setFocus();
    ensurePolished();
    resize(minimumWidth(), layout->totalHeightForWidth(minimumWidth())); // Qt would cut it to two thirds of the screen
}

Entry BuildDialog::addEntry(QVBoxLayout& layout, const QString& id, const QString& label, const QString& name,
                            const QString& hint, double low, double high, double value) {
    Entry entry{new ValueField(Quantity::level, low, high, value), new QLabel, name, low, high};
    entry.field->setObjectName(id);
    entry.field->setStep(1.0);
    entry.field->setToolTip(hint);
    entry.field->setValue(value);
    entry.wrong->setObjectName(id + ".wrong");
    entry.wrong->setProperty("look", "warning");
    entry.wrong->setWordWrap(true);
    entry.wrong->hide();
    QWidget* row = makeRow(label, entry.field);
    row->setToolTip(hint);
    layout.addWidget(row);
    layout.addWidget(entry.wrong);
    connect(entry.field, &QLineEdit::textChanged, this, &BuildDialog::check);
    connect(entry.field, &ValueField::committed, this,
            [field = entry.field](double number) { field->setValue(std::round(number)); });
    entry.field->installEventFilter(this);
    return entry;
}

bool BuildDialog::eventFilter(QObject* watched, QEvent* event) {
    if (event->type() != QEvent::KeyPress) return QDialog::eventFilter(watched, event);
    const int key = static_cast<QKeyEvent*>(event)->key();
    return (key == Qt::Key_Return || key == Qt::Key_Enter) && !build_->isEnabled();
}

void BuildDialog::addButtons(QVBoxLayout& layout) {
    auto* buttons = new QDialogButtonBox;
    build_ = buttons->addButton(tr("Build"), QDialogButtonBox::AcceptRole);
    build_->setObjectName("field.build.accept");
    build_->setProperty("look", "primary");
    build_->setDefault(true);
    buttons->addButton(QDialogButtonBox::Cancel)->setObjectName("field.build.cancel");
    connect(buttons, &QDialogButtonBox::accepted, this, &BuildDialog::start);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    layout.addWidget(buttons);
}

BuildOptions BuildDialog::options() const {
    const auto number = [](const Entry& entry) {
        return std::round(parseQuantity(entry.field->text(), Quantity::level).value_or(entry.field->value()));
    };
    BuildOptions options;
    options.resolution = static_cast<int>(number(resolution_));
    options.levels = static_cast<int>(number(levels_));
    options.samples = static_cast<int>(number(samples_));
    options.seed = static_cast<std::uint64_t>(number(seed_));
    return options;
}

void BuildDialog::check() {
    if (build_ == nullptr) return;
    bool fine = true;
    for (const Entry* entry : {&resolution_, &levels_, &samples_, &seed_}) {
        const QString fault = entry->fault();
        entry->wrong->setText(fault);
        entry->wrong->setVisible(!fault.isEmpty());
        fine = fine && fault.isEmpty();
    }
    build_->setEnabled(fine);
    if (fine)
        showEstimate();
    else
        estimate_->clear();
    const auto same = [chosen = options()](const Preset& preset) {
        return chosen.resolution == preset.resolution && chosen.levels == preset.levels &&
               chosen.samples == preset.samples;
    };
    const auto found = std::find_if(kPresets.begin(), kPresets.end(), same);
    const QSignalBlocker quiet(presets_);
    presets_->setCurrentIndex(static_cast<int>(found - kPresets.begin()));
}

void BuildDialog::showEstimate() {
    const auto& state = studio_.document.state();
    try {
        const Field* known = state.field.field ? &state.field.field->field : nullptr;
        const BuildEstimate estimate = estimateOf(*state.rig.rig, options(), known);
        QString text = tr("About %1 voxels of %2 mm; the field takes about %3.")
                           .arg(countText(estimate.frame.voxelCount()))
                           .arg(1000.0 * estimate.frame.voxelSize, 0, 'f', 2)
                           .arg(bytesText(estimate.bytes));
        if (estimate.work && *estimate.work >= 1.5)
            text += tr(" Building takes about %1 times as long as for the field in use.")
                        .arg(*estimate.work, 0, 'f', *estimate.work < 10.0 ? 1 : 0);
        estimate_->setText(text);
    } catch (const Error& error) {
        resolution_.wrong->setText(
            tr("%1; %2.").arg(QString::fromStdString(error.why()), QString::fromStdString(error.remedy())));
        resolution_.wrong->show();
        build_->setEnabled(false);
        estimate_->clear();
    }
}

void BuildDialog::applyPreset(int index) {
    if (index < 0 || index >= static_cast<int>(kPresets.size())) return;
    const Preset& preset = kPresets[static_cast<std::size_t>(index)];
    resolution_.field->setValue(preset.resolution);
    levels_.field->setValue(preset.levels);
    samples_.field->setValue(preset.samples);
    check();
}

void BuildDialog::start() {
    if (!build_->isEnabled()) return;
    const BuildOptions chosen = options();
    accept();
    studio_.project.buildField(chosen);
}

} // namespace

void openBuildDialog(Studio& studio, QWidget* parent) {
    if (auto* open = parent->findChild<QDialog*>("field.build.dialog")) {
        open->raise();
        open->activateWindow();
        return;
    }
    if (!studio.document.state().rig.rig) return;
    (new BuildDialog(studio, parent))->open();
}

} // namespace lumorph::studio
