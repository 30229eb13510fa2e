#include "app/workspaces/scene/collapsible_section.h"

#include <QFrame>
#include <QHBoxLayout>

#include "app/studio/look/icons.h"

namespace lumorph::studio {

CollapsibleSection::CollapsibleSection(const QString& name, const QString& title, bool open, QWidget* parent)
    : QWidget(parent), heading_(new QToolButton(this)), top_(new QHBoxLayout), content_(new QWidget(this)),
      rows_(new QVBoxLayout(content_)) {
    heading_->setObjectName(name);
    heading_->setProperty("look", "section");
    heading_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    heading_->setCheckable(true);
    heading_->setIconSize({14, 14});
    heading_->setFocusPolicy(Qt::StrongFocus);
    auto* line = new QFrame(this);
    line->setProperty("look", "hairline");
    top_->setContentsMargins(0, 0, 0, 0);
    top_->setSpacing(8);
    top_->addWidget(heading_);
    top_->addWidget(line, 1);
    rows_->setContentsMargins(0, 0, 0, 4);
    rows_->setSpacing(6);
    auto* all = new QVBoxLayout(this);
    all->setContentsMargins(0, 4, 0, 0);
    all->setSpacing(4);
    all->addLayout(top_);
    all->addWidget(content_);
    setTitle(title);
    connect(heading_, &QToolButton::clicked, this, [this](bool on) { setOpen(on); });
    setOpen(open);
}

void CollapsibleSection::setOpen(bool open) {
    heading_->setChecked(open);
    heading_->setIcon(icon(open ? "chevron-down" : "chevron-right", IconRole::muted));
    heading_->setToolTip(open ? tr("Fold away") : tr("Unfold"));
    content_->setVisible(open);
}

void CollapsibleSection::setTitle(const QString& title) {
    heading_->setText(title);
    heading_->setAccessibleName(title);
}

void CollapsibleSection::addToHeading(QWidget* widget) { top_->addWidget(widget); }

} // namespace lumorph::studio
