#include "app/studio/shell/demo_options.h"

#include <utility>
#include <vector>

#include <QDialog>
#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>

#include "app/applications/demo.h"
#include "app/studio/shell/dialog_fit.h"

namespace lumorph::studio {
namespace {

constexpr const char* kFolderKey = "applications/folder";
constexpr int kFieldWidth = 420;

class DemoOptions : public QDialog {
public:
    DemoOptions(Studio& studio, const Demo& demo, std::function<void()> start, QWidget* parent)
        : QDialog(parent), studio_(studio), demo_(demo), start_(std::move(start)) {
        setObjectName("dialog.options");
        setWindowTitle(studio.settings.say(demo.title));
        setAttribute(Qt::WA_DeleteOnClose);
        grid_ = new QGridLayout(this);
        grid_->setSpacing(8);
        const DemoTold told = studio.settings.toldTo(demo.name);
        for (const DemoOption& option : demo.options) {
            const auto known = told.find(option.name);
            addRow(option, known == told.end() ? std::string() : known->second);
        }
        addButtons();
    }

private:
    void addRow(const DemoOption& option, const std::string& text) {
        const int row = grid_->rowCount();
        auto* field = new QLineEdit(QString::fromStdString(text));
        field->setObjectName("options." + QString::fromStdString(option.name));
        field->setPlaceholderText(studio_.settings.say(option.hint));
        field->setToolTip(studio_.settings.say(option.hint));
        field->setMinimumWidth(kFieldWidth);
        field->setClearButtonEnabled(true);
        auto* title = new QLabel(studio_.settings.say(option.title));
        title->setBuddy(field);
        grid_->addWidget(title, row, 0);
        grid_->addWidget(field, row, 1);
        if (option.file) grid_->addWidget(makeChooser(*field), row, 2);
        fields_.push_back(field);
    }
    QPushButton* makeChooser(QLineEdit& field) {
        auto* button = new QPushButton(studio_.settings.say({"Choose...", "Auswählen..."}));
        button->setObjectName(field.objectName() + ".choose");
        button->setAutoDefault(false);
        connect(button, &QPushButton::clicked, this, [this, &field] {
            auto* dialog = new QFileDialog(this, windowTitle(), studio_.settings.value(kFolderKey).toString());
            dialog->setObjectName("dialog.options.file");
            dialog->setOption(QFileDialog::DontUseNativeDialog);
            dialog->setAttribute(Qt::WA_DeleteOnClose);
            dialog->setFileMode(QFileDialog::ExistingFile);
            connect(dialog, &QFileDialog::fileSelected, this, [this, &field](const QString& file) {
                studio_.settings.setValue(kFolderKey, QFileInfo(file).absolutePath());
                field.setText(file);
            });
            dialog->open();
        });
        return button;
    }
    void addButtons() {
        auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Reset | QDialogButtonBox::Cancel);
        QPushButton* start = buttons->button(QDialogButtonBox::Ok);
        start->setText(studio_.settings.say({"Start", "Starten"}));
        start->setObjectName("options.start");
        start->setProperty("look", "primary");
        QPushButton* usual = buttons->button(QDialogButtonBox::Reset);
        usual->setText(studio_.settings.say({"As usual", "Wie gewohnt"}));
        usual->setObjectName("options.usual");
        buttons->button(QDialogButtonBox::Cancel)->setText(studio_.settings.say({"Cancel", "Abbrechen"}));
        grid_->addWidget(buttons, grid_->rowCount(), 0, 1, 3);
        connect(start, &QPushButton::clicked, this, &DemoOptions::keep);
        connect(usual, &QPushButton::clicked, this, [this] {
            for (QLineEdit* field : fields_) field->clear();
        });
        connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
    }
    void keep() {
        DemoTold told;
        for (std::size_t k = 0; k < fields_.size(); ++k)
            if (const QString text = fields_[k]->text().trimmed(); !text.isEmpty())
                told[demo_.options[k].name] = text.toStdString();
        studio_.settings.setToldTo(demo_.name, told);
        accept();
        start_();
    }

    Studio& studio_;
    const Demo& demo_;
    std::function<void()> start_;
    QGridLayout* grid_;
    std::vector<QLineEdit*> fields_; ///< one an option
};

} // namespace

void openDemoOptions(Studio& studio, QWidget& window, const Demo& demo, std::function<void()> start) {
    if (auto* open = window.findChild<QDialog*>("dialog.options")) return open->raise();
    auto* dialog = new DemoOptions(studio, demo, std::move(start), &window);
    fitDialog(*dialog);
    dialog->open();
}

} // namespace lumorph::studio
