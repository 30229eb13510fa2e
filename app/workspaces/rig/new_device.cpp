#include "app/workspaces/rig/new_device.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include <QButtonGroup>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>

#include "app/studio/document/job_slots.h"
#include "app/studio/look/icons.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/segments.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/rig/device_preview.h"
#include "app/workspaces/rig/draw_sheet.h"
#include "app/workspaces/rig/rig_facts.h"
#include "core/base/error.h"
#include "core/rig/rig_file.h"
#include "core/rig/templates/rig_templates.h"
#include "core/rig/templates/sheet_file.h"

namespace lumorph::studio {

namespace {

using Unit = TemplateParameter::Unit;

constexpr const char* kPlace = "rig.new"; ///< of its job; notices are told in the window itself

/// What one unit of a parameter is in the field's own: metres, radians, pieces.
double unitOf(const TemplateParameter& parameter) {
    switch (parameter.unit) {
    case Unit::centimetres:
        return 0.01;
    case Unit::degrees:
        return Angle::degrees(1.0).inRadians();
    case Unit::count:
    case Unit::word:
        break;
    }
    return 1.0;
}

Quantity quantityOf(const TemplateParameter& parameter) {
    switch (parameter.unit) {
    case Unit::centimetres:
        return Quantity::length;
    case Unit::degrees:
        return Quantity::angle;
    case Unit::count:
    case Unit::word:
        break;
    }
    return Quantity::level;
}

/// "corner" as "Corner", "cornerX" as "Corner x".
QString labelOf(std::string_view name) {
    QString label;
    for (const char letter : name) {
        const QChar character = QLatin1Char(letter);
        if (character.isUpper()) label += ' ';
        label += label.isEmpty() ? character.toUpper() : character.toLower();
    }
    return label;
}

QString sentence(std::string_view text) {
    QString words = shownText(text);
    if (!words.isEmpty()) words[0] = words[0].toUpper();
    return words + '.';
}

QString offerText(ActuatorOffer::Kind kind) {
    switch (kind) {
    case ActuatorOffer::Kind::morphTarget:
        return QObject::tr("a shape key");
    case ActuatorOffer::Kind::animatedJoint:
        return QObject::tr("turned as its animation turns it");
    case ActuatorOffer::Kind::jointAtRest:
        break;
    }
    return QObject::tr("turned by 45° about its X axis");
}

/// A device as it was read from files.
struct ReadDevice {
    std::vector<ActuatorOffer> offers;
    std::shared_ptr<const Rig> rig;   ///< none while nothing of what is offered is taken
    std::shared_ptr<const Rig> still; ///< then, to look at: without actuators
};

/// `taken`: of the offers; none: what is usual.
ReadDevice readDevice(const std::filesystem::path& path, const std::optional<std::vector<std::size_t>>& taken) {
    ReadDevice device{offeredActuators(path), nullptr, nullptr};
    const std::vector<std::size_t> some = taken.value_or(usualOffers(device.offers));
    if (device.offers.empty())
        device.rig = std::make_shared<const Rig>(readRig(path));
    else if (!some.empty())
        device.rig = std::make_shared<const Rig>(readRig(path, some));
    if (device.rig) return device;
    RigParts still = readRig(path, std::vector<std::size_t>{0}).parts();
    still.actuators.clear();
    device.still = std::make_shared<const Rig>(std::move(still));
    return device;
}

class NewDevice : public QDialog {
public:
    NewDevice(Studio& studio, QWidget* parent);

private:
    QWidget* makeKinds();
    QWidget* makeSources();
    QWidget* makeSide();
    QWidget* makeButtons();
    void choose(const RigTemplate& kind);
    struct Measure {
        const TemplateParameter* parameter;
        QWidget* row;
        ValueField* field; ///< none where it is a word
        int word;          ///< its place
    };
    void addParameter(const TemplateParameter& parameter);
    void addWord(const TemplateParameter& parameter);
    void addMeasure(const Measure& measure);
    [[nodiscard]] std::vector<TemplateChoice> choices() const; ///< those that mean something
    void askSource(bool folder);
    void chooseSource(const std::filesystem::path& path);
    void forgetMeasures();
    void showOffers();
    void make(); ///< anew, beside the window; the newest wish wins
    void read(); ///< the same for what is not made of a template
    void take(const std::shared_ptr<const Rig>& rig);
    void refuse(const std::exception& why);
    void useIt();
    void drawIt();

    Studio& studio_;
    JobSlots jobs_;
    const RigTemplate* kind_ = nullptr;
    std::filesystem::path source_; ///< of a device that is read; empty for one of a template
    std::vector<ActuatorOffer> offers_;
    std::optional<std::vector<std::size_t>> taken_; ///< of the offers; none before they are known
    QAbstractButton* chosen_ = nullptr;             ///< the button of what is shown
    std::vector<Measure> chosenMeasures_;
    std::shared_ptr<const Rig> rig_; ///< of the last measures that make one
    bool isNewest_ = false;          ///< `rig_` is of the measures that are seen
    QButtonGroup* kinds_ = new QButtonGroup(this);
    QLabel* about_ = new QLabel;
    QWidget* measures_ = new QWidget;
    QLabel* wrong_ = new QLabel;
    QLabel* facts_ = new QLabel;
    DevicePreview* preview_;
    QPushButton* draw_ = nullptr;
    QPushButton* use_ = nullptr;
};

NewDevice::NewDevice(Studio& studio, QWidget* parent)
    : QDialog(parent), studio_(studio), jobs_(*this, studio.jobs, studio.notices),
      preview_(new DevicePreview(studio, kPlace)) {
    setObjectName("rig.new.dialog");
    setAttribute(Qt::WA_DeleteOnClose);
    setWindowTitle(tr("New device"));
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(16, 16, 16, 16);
    layout->setSpacing(12);
    layout->addWidget(makeKinds());
    layout->addWidget(makeSources());
    auto* middle = new QHBoxLayout;
    middle->setSpacing(16);
    middle->addWidget(makeSide());
    middle->addWidget(preview_, 1);
    layout->addLayout(middle, 1);
    layout->addWidget(makeButtons());
    chosen_ = kinds_->buttons().front();
    choose(rigTemplates().front());
    resize(920, 660);
}

QWidget* NewDevice::makeKinds() {
    auto* kinds = new QWidget;
    auto* layout = new QHBoxLayout(kinds);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    for (const RigTemplate& kind : rigTemplates()) {
        auto* button = new QToolButton;
        button->setObjectName("rig.new.kind." + QString::fromStdString(std::string(kind.name)));
        button->setText(labelOf(kind.name));
        button->setToolTip(sentence(kind.meaning));
        button->setCheckable(true);
        button->setChecked(layout->isEmpty());
        button->setMinimumHeight(32);
        button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
        kinds_->addButton(button);
        layout->addWidget(button);
        connect(button, &QToolButton::clicked, this, [this, button, kind = &kind] {
            chosen_ = button;
            choose(*kind);
        });
    }
    return kinds;
}

/// What is not made of a template but of files there are.
QWidget* NewDevice::makeSources() {
    auto* sources = new QWidget;
    auto* layout = new QHBoxLayout(sources);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    auto* label = new QLabel(tr("Or of what you have:"));
    label->setProperty("look", "muted");
    layout->addWidget(label);
    const auto add = [&](const char* name, const QString& text, const QString& tip, bool folder) {
        auto* button = new QToolButton;
        button->setObjectName(name);
        button->setText(text);
        button->setToolTip(tip);
        button->setIcon(icon(folder ? "folder" : "open"));
        button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
        button->setCheckable(true);
        button->setMinimumHeight(32);
        button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
        kinds_->addButton(button);
        layout->addWidget(button, 1);
        connect(button, &QToolButton::clicked, this, [this, folder] { askSource(folder); });
    };
    add("rig.new.mesh", tr("From a mesh or glTF..."),
        tr("A glTF with actuators, or with bones or shape keys (morph targets), of which you choose"), false);
    add("rig.new.states", tr("From a folder of states..."),
        tr("rest.obj and one mesh of the same triangles for each state: left_1.obj, left_2.obj, right_1.obj"), true);
    return sources;
}

void NewDevice::askSource(bool folder) {
    auto* dialog = new QFileDialog(this, folder ? tr("A folder of one mesh a state") : tr("A mesh or glTF"),
                                   studio_.settings.value(kRigFolder).toString());
    dialog->setObjectName("rig.new.file");
    dialog->setOption(QFileDialog::DontUseNativeDialog);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setFileMode(folder ? QFileDialog::Directory : QFileDialog::ExistingFile);
    if (folder)
        dialog->setOption(QFileDialog::ShowDirsOnly);
    else
        dialog->setNameFilters({tr("Models (*.glb *.gltf *.obj *.stl *.ply *.off)"), tr("All files (*)")});
    connect(dialog, &QFileDialog::fileSelected, this, [this, folder](const QString& path) {
        studio_.settings.setValue(kRigFolder, QFileInfo(path).absolutePath());
        chosen_ = findChild<QAbstractButton*>(folder ? "rig.new.states" : "rig.new.mesh");
        chosen_->setChecked(true);
        chooseSource(std::filesystem::path(path.toStdU16String()));
    });
    connect(dialog, &QFileDialog::finished, this, [this] { chosen_->setChecked(true); });
    dialog->open();
}

void NewDevice::chooseSource(const std::filesystem::path& path) {
    kind_ = nullptr;
    source_ = path;
    offers_.clear();
    taken_.reset();
    forgetMeasures();
    about_->setText(tr("Read from %1.").arg(QString::fromStdString(path.string())));
    facts_->clear();
    wrong_->clear();
    rig_.reset();
    preview_->show(nullptr);
    preview_->frameNext();
    make();
}

/// What may become actuators, to be ticked.
void NewDevice::showOffers() {
    auto* heading = new QLabel(tr("Tick what servos shall move:"));
    auto* list = new QListWidget;
    list->setObjectName("rig.new.offers");
    list->setAccessibleName(tr("Joints and morph targets"));
    list->setSelectionMode(QAbstractItemView::NoSelection);
    list->setMinimumHeight(220);
    list->setSpacing(2);
    for (const ActuatorOffer& offer : offers_) {
        auto* item = new QListWidgetItem(tr("%1, %2").arg(QString::fromStdString(offer.name), offerText(offer.kind)));
        item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsUserCheckable);
        const auto index = static_cast<std::size_t>(list->count());
        item->setCheckState(std::ranges::find(*taken_, index) != taken_->end() ? Qt::Checked : Qt::Unchecked);
        list->addItem(item);
    }
    connect(list, &QListWidget::itemChanged, this, [this, list] {
        taken_.emplace();
        for (int row = 0; row < list->count(); ++row)
            if (list->item(row)->checkState() == Qt::Checked) taken_->push_back(static_cast<std::size_t>(row));
        make();
    });
    measures_->layout()->addWidget(heading);
    measures_->layout()->addWidget(list);
}

void NewDevice::forgetMeasures() {
    chosenMeasures_.clear();
    while (QLayoutItem* item = measures_->layout()->takeAt(0)) {
        item->widget()->hide();
        item->widget()->deleteLater(); // the field that is left may be telling its number right now
        delete item;
    }
}

QWidget* NewDevice::makeSide() {
    auto* side = new QWidget;
    side->setFixedWidth(300);
    auto* layout = new QVBoxLayout(side);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    about_->setWordWrap(true);
    wrong_->setObjectName("rig.new.wrong");
    wrong_->setProperty("look", "warning");
    wrong_->setWordWrap(true);
    facts_->setObjectName("rig.new.facts");
    facts_->setProperty("look", "muted");
    facts_->setWordWrap(true);
    new QVBoxLayout(measures_);
    measures_->layout()->setContentsMargins(0, 0, 0, 0);
    measures_->layout()->setSpacing(4);
    layout->addWidget(about_);
    layout->addWidget(measures_);
    layout->addWidget(wrong_);
    layout->addWidget(facts_);
    layout->addStretch(1);
    layout->addWidget(makeJobBar(studio_.jobs, kPlace));
    return side;
}

QWidget* NewDevice::makeButtons() {
    auto* buttons = new QDialogButtonBox;
    draw_ = buttons->addButton(tr("Draw on it..."), QDialogButtonBox::ActionRole);
    draw_->setObjectName("rig.new.draw");
    draw_->setToolTip(tr("Opens the page on which this sheet's outline and bend lines are drawn"));
    draw_->setAutoDefault(false);
    draw_->hide();
    use_ = buttons->addButton(tr("Make this device"), QDialogButtonBox::AcceptRole);
    use_->setObjectName("rig.new.accept");
    connect(draw_, &QPushButton::clicked, this, &NewDevice::drawIt);
    buttons->addButton(QDialogButtonBox::Cancel)->setObjectName("rig.new.cancel");
    connect(buttons, &QDialogButtonBox::accepted, this, &NewDevice::useIt);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    return buttons;
}

void NewDevice::choose(const RigTemplate& kind) {
    if (kind_ == &kind) return;
    kind_ = &kind;
    source_.clear();
    about_->setText(sentence(kind.meaning));
    forgetMeasures();
    for (const TemplateParameter& parameter : kind.parameters) addParameter(parameter);
    preview_->frameNext(); // another kind is looked at from where all of it is seen
    make();
}

void NewDevice::addParameter(const TemplateParameter& parameter) {
    if (parameter.unit == Unit::word) return addWord(parameter);
    const double unit = unitOf(parameter);
    auto* field =
        new ValueField(quantityOf(parameter), unit * parameter.min, unit * parameter.max, unit * parameter.value);
    field->setObjectName("rig.new." + QString::fromStdString(std::string(parameter.name)));
    field->setToolTip(sentence(parameter.meaning) + "\n" + field->toolTip());
    field->setRefusing(true);
    field->setStep(parameter.unit == Unit::count ? 1.0 : unit * (parameter.max < 5.0 ? 0.1 : 0.5));
    field->setValue(unit * parameter.value);
    addMeasure({&parameter, makeRow(labelOf(parameter.name), field), field, 0});
    connect(field, &ValueField::previewed, this, &NewDevice::make);
    connect(field, &ValueField::reverted, this, &NewDevice::make);
    connect(field, &ValueField::committed, this, [this, field, counts = parameter.unit == Unit::count](double number) {
        if (counts) field->setValue(std::round(number));
        make();
    });
    connect(field, &ValueField::refused, wrong_, &QLabel::setText);
}

void NewDevice::addWord(const TemplateParameter& parameter) {
    std::vector<Segments::Segment> segments;
    for (const std::string_view word : parameter.words)
        segments.push_back({"rig.new." + QString::fromStdString(std::string(word)), labelOf(word), {}});
    auto* choice = new Segments(segments);
    choice->setChosen(static_cast<int>(parameter.value));
    addMeasure({&parameter, makeRow(labelOf(parameter.name), choice), nullptr, static_cast<int>(parameter.value)});
    connect(choice, &Segments::chosen, this, [this, place = chosenMeasures_.size() - 1](int word) {
        chosenMeasures_[place].word = word;
        make();
    });
}

void NewDevice::addMeasure(const Measure& measure) {
    measure.row->setToolTip(sentence(measure.parameter->meaning));
    measures_->layout()->addWidget(measure.row);
    chosenMeasures_.push_back(measure);
}

std::vector<TemplateChoice> NewDevice::choices() const {
    std::vector<TemplateChoice> all;
    for (const auto& [parameter, row, field, word] : chosenMeasures_) {
        const double value = field == nullptr ? word : field->value() / unitOf(*parameter);
        all.emplace_back(std::string(parameter->name), parameter->unit == Unit::count ? std::round(value) : value);
    }
    std::vector<TemplateChoice> meant;
    for (std::size_t k = 0; k < all.size(); ++k)
        if (applies(*kind_, *chosenMeasures_[k].parameter, all)) meant.push_back(all[k]);
    return meant;
}

void NewDevice::make() {
    isNewest_ = false;
    use_->setEnabled(false);
    draw_->setEnabled(false);
    if (!source_.empty()) return read();
    const std::vector<TemplateChoice> chosen = choices();
    for (const Measure& measure : chosenMeasures_)
        measure.row->setVisible(std::ranges::find(chosen, measure.parameter->name, &TemplateChoice::first) !=
                                chosen.end());
    jobs_.runWith<std::shared_ptr<const Rig>>(
        "make", kPlace, tr("Making the device"),
        [kind = kind_, chosen](const Progress& progress) -> std::shared_ptr<const Rig> {
            return std::make_shared<const Rig>(rigOf(*kind, chosen, progress, SheetQuality::preview));
        },
        [this](const std::shared_ptr<const Rig>& rig) { take(rig); },
        [this](const std::exception& error) { refuse(error); });
}

void NewDevice::read() {
    jobs_.runWith<ReadDevice>(
        "make", kPlace, tr("Reading the device"),
        [path = source_, taken = taken_](const Progress&) { return readDevice(path, taken); },
        [this](const ReadDevice& device) {
            const bool first = !taken_;
            offers_ = device.offers;
            if (first && !offers_.empty()) {
                taken_ = usualOffers(offers_);
                showOffers();
            }
            if (device.rig) return take(device.rig);
            rig_.reset();
            facts_->clear();
            wrong_->setText(tr("Tick at least one: a device without actuators does not change its shape."));
            preview_->show(device.still);
        },
        [this](const std::exception& error) { refuse(error); });
}

void NewDevice::take(const std::shared_ptr<const Rig>& rig) {
    rig_ = rig;
    isNewest_ = true;
    use_->setEnabled(true);
    draw_->setEnabled(true);
    wrong_->clear();
    const Box reach = rig->reach();
    facts_->setText(tr("Servos: %1. Over all states it takes %2.")
                        .arg(rig->actuatorCount())
                        .arg(sizeText(static_cast<double>(reach.size().x), static_cast<double>(reach.size().y),
                                      static_cast<double>(reach.size().z))));
    // What moves nothing yet is there to be drawn on.
    draw_->setVisible(!rig->parts().drawing.empty());
    const bool blank = rig->actuatorCount() == 0;
    (blank ? draw_ : use_)->setDefault(true);
    preview_->show(rig);
}

/// The last device that could be made stays in sight, with why these measures make none.
void NewDevice::refuse(const std::exception& why) {
    const Notice notice = noticeOf(why);
    wrong_->setText(tr("%1: %2. %3.").arg(notice.subject, notice.why, notice.remedy));
}

void NewDevice::useIt() {
    if (!rig_ || !isNewest_) return;
    const QString name = kind_ ? labelOf(kind_->name).toLower() : QString::fromStdString(source_.stem().string());
    const auto use = [this, name](const std::shared_ptr<const Rig>& rig) {
        accept();
        studio_.project.takeRig(rig, name);
    };
    if (!source_.empty() || !rig_->parts().sheet) return use(rig_);
    // What is seen is solved coarsely.
    use_->setEnabled(false);
    jobs_.runWith<std::shared_ptr<const Rig>>(
        "make", kPlace, tr("Solving the sheet"),
        [kind = kind_, chosen = choices()](const Progress& progress) -> std::shared_ptr<const Rig> {
            return std::make_shared<const Rig>(rigOf(*kind, chosen, progress));
        },
        use,
        [this](const std::exception& error) {
            refuse(error);
            use_->setEnabled(true);
        });
}

void NewDevice::drawIt() {
    if (!rig_ || !isNewest_) return;
    SheetDevice drawing = parseSheetDevice(rig_->parts().drawing, rig_->name());
    accept();
    openDrawSheet(studio_, parentWidget(), std::move(drawing));
}

} // namespace

void openNewDevice(Studio& studio, QWidget* parent) {
    if (auto* open = parent->findChild<QDialog*>("rig.new.dialog")) {
        open->raise();
        open->activateWindow();
        return;
    }
    (new NewDevice(studio, parent))->open();
}

} // namespace lumorph::studio
