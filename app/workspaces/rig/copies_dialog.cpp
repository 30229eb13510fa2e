#include "app/workspaces/rig/copies_dialog.h"

#include <array>
#include <cmath>

#include <QComboBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QLabel>
#include <QPushButton>
#include <QStyle>
#include <QVBoxLayout>

#include "app/studio/document/rig_edit.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/value_field.h"
#include "core/base/error.h"
#include "core/rig/actuator_copies.h"

namespace lumorph::studio {

namespace {

class CopiesDialog : public QDialog {
public:
    CopiesDialog(Studio& studio, std::size_t actuator, QWidget* parent)
        : QDialog(parent), studio_(studio), actuator_(actuator), where_(new QComboBox),
          count_(new ValueField(Quantity::plain, 2.0, kMostCopies, 4.0)),
          along_(new ValueField(Quantity::length, -1.0, 1.0, 0.05)),
          across_(new ValueField(Quantity::length, -1.0, 1.0, 0.0)), says_(new QLabel) {
        setObjectName("dialog.copies");
        setWindowTitle("Copies of " + name());
        setAttribute(Qt::WA_DeleteOnClose);
        auto* layout = new QVBoxLayout(this);
        layout->setSpacing(8);
        where_->setObjectName("rig.copies.where");
        where_->addItems({"Around the middle", "Along a line"});
        count_->setObjectName("rig.copies.count");
        count_->setStep(1.0);
        along_->setObjectName("rig.copies.x");
        across_->setObjectName("rig.copies.z");
        count_->setValue(4.0);
        along_->setValue(0.05);
        across_->setValue(0.0);
        layout->addWidget(makeRow("&Where", where_));
        layout->addWidget(makeRow("&How many in all", count_));
        steps_ = {makeRow("To the &right", along_), makeRow("To the &front", across_)};
        for (QWidget* row : steps_) layout->addWidget(row);
        says_->setObjectName("rig.copies.says");
        says_->setWordWrap(true);
        says_->setMinimumWidth(360);
        layout->addWidget(says_);
        buttons_ = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
        buttons_->button(QDialogButtonBox::Ok)->setText("Make them");
        buttons_->button(QDialogButtonBox::Ok)->setObjectName("rig.copies.make");
        buttons_->button(QDialogButtonBox::Ok)->setProperty("look", "primary");
        layout->addWidget(buttons_);
        connect(buttons_, &QDialogButtonBox::accepted, this, &CopiesDialog::make);
        connect(buttons_, &QDialogButtonBox::rejected, this, &QDialog::reject);
        connect(where_, &QComboBox::currentIndexChanged, this, &CopiesDialog::look);
        for (ValueField* field : {count_, along_, across_})
            connect(field, &ValueField::committed, this, &CopiesDialog::look);
        look();
    }

private:
    [[nodiscard]] QString name() const {
        const auto& parts = studio_.document.state().rig.parts;
        return parts && actuator_ < parts->actuators.size() ? QString::fromStdString(parts->actuators[actuator_].name)
                                                            : QString();
    }
    [[nodiscard]] ActuatorCopies copies() const {
        const auto& parts = studio_.document.state().rig.parts;
        if (!parts || actuator_ >= parts->actuators.size())
            throw InvalidInput("actuator", "it is not there any more", "choose one anew");
        const int count = static_cast<int>(std::lround(count_->value()));
        if (where_->currentIndex() == 0) return copiesAround(*parts, actuator_, count);
        return copiesAlong(*parts, actuator_, count,
                           {static_cast<float>(along_->value()), 0.0F, static_cast<float>(across_->value())});
    }
    /// Says what would come of it.
    void look() {
        const bool line = where_->currentIndex() == 1;
        for (QWidget* row : steps_) row->setVisible(line);
        count_->setValue(std::round(count_->value()));
        bool can = true;
        try {
            const ActuatorCopies made = copies();
            const int there = static_cast<int>(made.actuators.size()) - made.added;
            QString text = QString("Adds %1 %2.").arg(made.added).arg(made.added == 1 ? "actuator" : "actuators");
            if (there > 0)
                text += QString(" %1 that %2 there already will move as %3 does.")
                            .arg(there)
                            .arg(there == 1 ? "stands" : "stand", name());
            says_->setText(text);
        } catch (const Error& error) {
            const QString why = QString::fromStdString(error.why());
            says_->setText(why.left(1).toUpper() + why.mid(1) + ": " + QString::fromStdString(error.remedy()) + ".");
            can = false;
        }
        says_->setProperty("look", can ? "muted" : "warning");
        says_->style()->unpolish(says_);
        says_->style()->polish(says_);
        buttons_->button(QDialogButtonBox::Ok)->setEnabled(can);
        adjustSize();
    }
    void make() {
        try {
            const ActuatorCopies made = copies();
            editRig(studio_.document, QString("Copy %1").arg(name()),
                    [&made](RigParts& parts) { parts.actuators = made.parts.actuators; });
            accept();
        } catch (const Error&) {
            look(); // it says why
        }
    }

    Studio& studio_;
    std::size_t actuator_;
    QComboBox* where_;
    ValueField *count_, *along_, *across_;
    QLabel* says_;
    std::array<QWidget*, 2> steps_{};
    QDialogButtonBox* buttons_ = nullptr;
};

} // namespace

void openCopiesDialog(Studio& studio, std::size_t actuator, QWidget* parent) {
    if (auto* open = parent ? parent->findChild<QDialog*>("dialog.copies") : nullptr) return open->raise();
    (new CopiesDialog(studio, actuator, parent))->open();
}

} // namespace lumorph::studio
