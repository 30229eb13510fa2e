#include <QVBoxLayout>

#include "app/studio/widgets/notice_card.h"
#include "app/studio/widgets/panel.h"

namespace lumorph::studio {

QWidget* makeNoticeBar(Notices& notices, const QString& place, QWidget* parent) {
    auto* bar = new QWidget(parent);
    bar->setObjectName("notices." + place);
    auto* layout = new QVBoxLayout(bar);
    layout->setContentsMargins(0, 0, 0, 0);
    const auto refresh = [bar, layout, &notices, place] {
        while (QLayoutItem* old = layout->takeAt(0)) {
            old->widget()->hide();
            old->widget()->deleteLater(); // it may be the button's own click that removes it
            delete old;
        }
        const auto found = notices.at(place);
        if (!found.empty()) layout->addWidget(makeNoticeCard(notices, place, found.front(), {}, bar));
        bar->setVisible(!found.empty());
    };
    QObject::connect(&notices, &Notices::changed, bar, [refresh, place](const QString& where) {
        if (where == place || where.isEmpty()) refresh();
    });
    refresh();
    return bar;
}

} // namespace lumorph::studio
