#include "app/studio/shell/notice_list.h"

#include <QApplication>
#include <QFrame>
#include <QKeyEvent>
#include <QLabel>
#include <QMouseEvent>
#include <QPushButton>
#include <QScrollArea>
#include <QVBoxLayout>

#include "app/studio/look/icons.h"
#include "app/studio/shell/escape_twice.h"
#include "app/studio/widgets/notice_card.h"

namespace lumorph::studio {
namespace {

constexpr int kWidth = 420;

/// Where a notice belongs, in the user's words.
QString placeTitle(const QString& place) {
    if (place == "viewport") return "View";
    QString title = place;
    if (!title.isEmpty()) title[0] = title[0].toUpper();
    return title;
}

class NoticeList : public QFrame {
public:
    NoticeList(Notices& notices, std::set<QString> places, std::vector<QString> warnings, QWidget* window)
        : QFrame(window), notices_(notices), places_(std::move(places)), warnings_(std::move(warnings)) {
        setObjectName("notices.list");
        setProperty("look", "popup");
        setFocusPolicy(Qt::StrongFocus);
        setProperty("noFocusRing", true);
        setAttribute(Qt::WA_DeleteOnClose);
        auto* outer = new QVBoxLayout(this);
        outer->setContentsMargins(1, 1, 1, 1);
        area_ = new QScrollArea(this);
        area_->setWidgetResizable(true);
        area_->setFrameShape(QFrame::NoFrame);
        area_->setFocusPolicy(Qt::NoFocus);
        outer->addWidget(area_);
        connect(&notices, &Notices::changed, this, [this] { fill(); });
        fill();
        EscapeTwice::setCloses(*this);
        qApp->installEventFilter(this);
    }

    void setWarnings(const std::vector<QString>& warnings) {
        // Shares of a moving target change all the time; cards that are made anew under the pointer help nobody.
        if (warnings.size() == warnings_.size()) return;
        warnings_ = warnings;
        fill();
    }

    void openAt(const QPoint& corner) {
        corner_ = corner;
        place();
        show();
        raise();
        setFocus(Qt::PopupFocusReason);
    }

protected:
    bool eventFilter(QObject* watched, QEvent* event) override {
        if (event->type() == QEvent::MouseButtonPress && watched->isWidgetType()) {
            const auto* widget = static_cast<QWidget*>(watched);
            if (widget != this && !isAncestorOf(widget) && widget->objectName() != "status.warnings") close();
        }
        return QFrame::eventFilter(watched, event);
    }
    void keyPressEvent(QKeyEvent* event) override {
        if (event->key() == Qt::Key_Escape)
            close();
        else
            QFrame::keyPressEvent(event);
    }

private:
    void fill() {
        auto* content = new QWidget;
        content->setProperty("look", "column");
        auto* column = new QVBoxLayout(content);
        column->setContentsMargins(12, 12, 12, 12);
        column->setSpacing(8);
        if (notices_.at().size() > 1) {
            auto* all = new QPushButton("Dismiss all", content);
            all->setObjectName("notices.dismissAll");
            all->setToolTip("Takes all notices away; warnings of the match stay while they are true");
            column->addWidget(all, 0, Qt::AlignRight);
            connect(all, &QPushButton::clicked, this, [this] { notices_.dismissAll(); });
        }
        for (const QString& place : places_)
            for (const Notice& notice : notices_.at(place))
                column->addWidget(makeNoticeCard(notices_, place, notice, placeTitle(place), content));
        for (const QString& warning : warnings_) {
            Notice notice;
            notice.level = Notice::Level::warning;
            notice.subject = warning;
            column->addWidget(makeNoticeCard(notices_, {}, notice, "Target", content, false));
        }
        if (column->count() == 0) {
            auto* none = new QLabel("Nothing to warn of.", content);
            none->setProperty("look", "muted");
            column->addWidget(none);
        }
        // The old content goes only after the click that dismissed one of its cards.
        if (QWidget* old = area_->takeWidget()) {
            old->hide();
            old->deleteLater();
        }
        area_->setWidget(content);
        if (isVisible()) place();
    }

    void place() {
        const int width = std::min(kWidth, parentWidget()->width() - 16);
        QWidget* content = area_->widget();
        content->ensurePolished();
        const int wish = content->layout()->hasHeightForWidth() ? content->layout()->totalHeightForWidth(width - 8)
                                                                : content->sizeHint().height();
        const int height = std::min(wish + 8, corner_.y() - 48);
        setGeometry(corner_.x() - width, corner_.y() - 8 - height, width, height);
    }

    Notices& notices_;
    std::set<QString> places_;
    std::vector<QString> warnings_;
    QScrollArea* area_ = nullptr;
    QPoint corner_;
};

} // namespace

QWidget* makeNoticeList(Notices& notices, const std::set<QString>& places, const std::vector<QString>& warnings,
                        QWidget* window) {
    return new NoticeList(notices, places, warnings, window);
}

void updateNoticeList(QWidget& list, const std::vector<QString>& warnings) {
    static_cast<NoticeList&>(list).setWarnings(warnings);
}

void openNoticeList(QWidget& list, const QPoint& corner) { static_cast<NoticeList&>(list).openAt(corner); }

} // namespace lumorph::studio
