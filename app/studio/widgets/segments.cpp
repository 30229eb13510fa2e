#include "app/studio/widgets/segments.h"

#include <QHBoxLayout>
#include <QPushButton>

namespace lumorph::studio {

Segments::Segments(const std::vector<Segment>& segments, QWidget* parent) : QWidget(parent) {
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(4);
    int index = 0;
    for (const Segment& segment : segments) {
        auto* button = new QPushButton(segment.text, this);
        button->setObjectName(segment.name);
        button->setToolTip(segment.hint);
        button->setCheckable(true);
        button->setProperty("look", "segment");
        group_.addButton(button, index++);
        row->addWidget(button, 1);
    }
    connect(&group_, &QButtonGroup::idClicked, this, &Segments::chosen);
}

void Segments::setSegment(int index, const QString& text, const QString& hint, bool isOffered) {
    QAbstractButton* button = group_.button(index);
    if (button == nullptr) return;
    button->setText(text);
    button->setToolTip(hint);
    button->setVisible(isOffered);
}

void Segments::setChosen(int index) {
    if (QAbstractButton* button = group_.button(index)) button->setChecked(true);
}

} // namespace lumorph::studio
