#include "app/studio/shell/dock_title.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPainter>
#include <QStyleOption>
#include <QToolButton>

#include "app/studio/look/icons.h"
#include "app/studio/widgets/icon_label.h"

namespace lumorph::studio {
namespace {

/// A plain QWidget paints its style sheet only when it is told to.
class DockTitle : public QWidget {
public:
    DockTitle() {
        setObjectName("dockTitle");
        setAttribute(Qt::WA_StyledBackground);
    }
    [[nodiscard]] QSize sizeHint() const override { return {QWidget::sizeHint().width(), kHeight}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {QWidget::minimumSizeHint().width(), kHeight}; }

private:
    static constexpr int kHeight = 33; ///< with the hairline below
};

QToolButton* makeTitleButton(const QString& name, const QString& does, QWidget* parent) {
    auto* button = new QToolButton(parent);
    button->setObjectName(name == "close" ? "dock.close" : "dock.float");
    button->setProperty("look", "title");
    button->setIcon(icon(name, IconRole::muted));
    button->setIconSize(QSize(14, 14));
    button->setToolTip(does);
    button->setAccessibleName(does);
    button->setFocusPolicy(Qt::TabFocus);
    return button;
}

} // namespace

QWidget* makeDockTitle(QDockWidget& dock, const QString& iconName) {
    auto* bar = new DockTitle;
    auto* row = new QHBoxLayout(bar);
    row->setContentsMargins(12, 0, 6, 0);
    row->setSpacing(8);
    if (!iconName.isEmpty()) row->addWidget(new IconLabel(iconName, IconRole::muted, 16, bar));
    auto* title = new QLabel(dock.windowTitle(), bar);
    title->setAttribute(Qt::WA_TransparentForMouseEvents);
    title->setMinimumWidth(1);
    row->addWidget(title, 1);
    auto* floating = makeTitleButton("frame", "Float or dock", bar);
    QObject::connect(floating, &QToolButton::clicked, &dock, [&dock] {
        dock.setFloating(!dock.isFloating());
        if (dock.isFloating())
            dock.move(dock.pos() + QPoint(-32, 32)); // off its old place, so that it is seen to float
    });
    auto* close = makeTitleButton("close", "Close; the View menu shows it again", bar);
    QObject::connect(close, &QToolButton::clicked, &dock, &QDockWidget::close);
    row->addWidget(floating);
    row->addWidget(close);
    const auto follow = [&dock, floating, close](QDockWidget::DockWidgetFeatures features) {
        floating->setVisible(features.testFlag(QDockWidget::DockWidgetFloatable));
        close->setVisible(features.testFlag(QDockWidget::DockWidgetClosable));
    };
    QObject::connect(&dock, &QDockWidget::featuresChanged, bar, follow);
    QObject::connect(&dock, &QWidget::windowTitleChanged, title, &QLabel::setText);
    return bar;
}

} // namespace lumorph::studio
