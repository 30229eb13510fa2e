#include "app/studio/widgets/panel.h"

#include <QAction>
#include <QComboBox>
#include <QEvent>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>

#include "app/studio/look/icons.h"
#include "app/studio/widgets/icon_label.h"

namespace lumorph::studio {
namespace {

/// A button that does what the action does, and greys with it.
QPushButton* makeActionButton(QAction* action, QWidget* parent) {
    auto* button = new QPushButton(parent);
    button->setProperty("look", "primary");
    button->setObjectName("empty." + action->objectName());
    const auto follow = [button, action] {
        button->setText(action->iconText());
        button->setEnabled(action->isEnabled());
        button->setToolTip(action->toolTip());
    };
    follow();
    QObject::connect(action, &QAction::changed, button, follow);
    QObject::connect(button, &QPushButton::clicked, action, &QAction::trigger);
    return button;
}

/// Takes the width it is given: the contents stretch sideways, and only the height scrolls.
class ColumnArea : public QScrollArea {
public:
    explicit ColumnArea(QWidget* parent) : QScrollArea(parent) {
        setWidgetResizable(true);
        setFrameShape(QFrame::NoFrame);
        setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        setFocusPolicy(Qt::NoFocus);
    }
    [[nodiscard]] QSize minimumSizeHint() const override {
        const int content = widget() == nullptr ? 0 : widget()->minimumSizeHint().width();
        return {content + 14, 80};
    }
    [[nodiscard]] QSize sizeHint() const override {
        const QSize content = widget() == nullptr ? QSize(240, 240) : widget()->sizeHint();
        return {std::max(240, content.width() + 14), content.height()};
    }

protected:
    /// A notice that comes up may need more width than the dock has.
    bool eventFilter(QObject* watched, QEvent* event) override {
        if (event->type() == QEvent::LayoutRequest) updateGeometry();
        return QScrollArea::eventFilter(watched, event);
    }
};

} // namespace

QWidget* makeEmptyState(const QString& iconName, const QString& title, const QString& text, QAction* action,
                        QWidget* parent) {
    auto* state = new QWidget(parent);
    state->setObjectName("emptyState");
    auto* column = new QVBoxLayout(state);
    column->setContentsMargins(16, 24, 16, 24);
    column->setSpacing(8);
    column->addStretch(2);
    column->addWidget(new IconLabel(iconName, IconRole::muted, 32, state), 0, Qt::AlignHCenter);
    for (const auto& [words, look] : {std::pair(title, "heading"), std::pair(text, "muted")}) {
        auto* label = new QLabel(words, state);
        label->setProperty("look", look);
        label->setAlignment(Qt::AlignHCenter);
        label->setWordWrap(true);
        column->addWidget(label);
    }
    if (action != nullptr) {
        column->addSpacing(8);
        column->addWidget(makeActionButton(action, state), 0, Qt::AlignHCenter);
    }
    column->addStretch(3);
    return state;
}

QWidget* makeHeading(const QString& text, QWidget* parent) {
    auto* heading = new QWidget(parent);
    auto* row = new QHBoxLayout(heading);
    row->setContentsMargins(0, 8, 0, 0);
    row->setSpacing(8);
    auto* label = new QLabel(text, heading);
    label->setProperty("look", "heading");
    auto* line = new QFrame(heading);
    line->setProperty("look", "hairline");
    row->addWidget(label);
    row->addWidget(line, 1);
    return heading;
}

Column makeColumn(QWidget* parent) {
    auto* area = new ColumnArea(parent);
    auto* content = new QWidget;
    content->setProperty("look", "column");
    auto* layout = new QVBoxLayout(content);
    layout->setContentsMargins(16, 8, 16, 16);
    layout->setSpacing(8);
    layout->setAlignment(Qt::AlignTop);
    area->setWidget(content);
    return {area, layout};
}

namespace {

/// Over a chooser in a column that scrolls, the wheel scrolls on instead of choosing.
class CalmWheel : public QObject {
public:
    using QObject::QObject;

protected:
    bool eventFilter(QObject* /*watched*/, QEvent* event) override {
        if (event->type() != QEvent::Wheel) return false;
        event->ignore();
        return true;
    }
};

} // namespace

QWidget* makeRow(const QString& label, QWidget* control, QWidget* parent) {
    auto* row = new QWidget(parent);
    auto* layout = new QHBoxLayout(row);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    auto* name = new QLabel(label, row);
    name->setProperty("look", "muted");
    name->setBuddy(control);
    if (control->accessibleName().isEmpty()) control->setAccessibleName(QString(label).remove('&'));
    if (qobject_cast<QComboBox*>(control)) control->installEventFilter(new CalmWheel(control));
    layout->addWidget(name, 2);
    layout->addWidget(control, 3);
    return row;
}

} // namespace lumorph::studio
