#include "app/workspaces/calibrate/state_row.h"

#include <QHBoxLayout>
#include <QVBoxLayout>

namespace lumorph::studio {

StateRow::StateRow(QWidget& host, const QMargins& margins)
    : host_(host), icon_(new IconLabel("minus", IconRole::muted, 20, &host)), title_(new QLabel(&host)),
      how_(new QLabel(&host)), words_(new QLabel(&host)) {
    title_->setProperty("look", "heading");
    how_->setObjectName(host.objectName() + ".how");
    how_->setProperty("look", "badge");
    words_->setObjectName(host.objectName() + ".words");
    words_->setProperty("look", "muted");
    for (QLabel* label : {title_, words_}) label->setWordWrap(true);
    for (QLabel* label : {title_, how_, words_}) {
        label->setTextFormat(Qt::PlainText);
        label->setAttribute(Qt::WA_TransparentForMouseEvents); // the host is what is clicked
    }
    auto* top = new QHBoxLayout;
    top->setSpacing(8);
    top->addWidget(title_, 1);
    top->addWidget(how_, 0, Qt::AlignTop);
    auto* texts = new QVBoxLayout;
    texts->setSpacing(2);
    texts->addLayout(top);
    texts->addWidget(words_);
    auto* row = new QHBoxLayout(&host);
    row->setContentsMargins(margins);
    row->setSpacing(8);
    row->addWidget(icon_, 0, Qt::AlignTop);
    row->addLayout(texts, 1);
}

void StateRow::show(const StateRowText& text) {
    icon_->setIcon(text.icon, text.role);
    title_->setText(text.number > 0 ? QString("%1  %2").arg(text.number).arg(text.title) : text.title);
    how_->setText(text.state);
    words_->setText(text.words);
    const QString name = text.number > 0 ? QString("Step %1, %2").arg(text.number).arg(text.title) : text.title;
    host_.setAccessibleName(QString("%1: %2").arg(name, text.state));
}

} // namespace lumorph::studio
