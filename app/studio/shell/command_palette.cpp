#include "app/studio/shell/command_palette.h"

#include <QAbstractListModel>
#include <QKeyEvent>
#include <QLineEdit>
#include <QListView>
#include <QPainter>
#include <QPointer>
#include <QStyledItemDelegate>
#include <QVBoxLayout>

#include "app/studio/look/icons.h"
#include "app/studio/look/palette.h"
#include "app/studio/shell/command_search.h"
#include "app/studio/shell/overlay.h"

namespace lumorph::studio {
namespace {

constexpr int kRowHeight = 36;
constexpr int kRows = 9;

enum Role { kShortcut = Qt::UserRole, kMenu };

class CommandList : public QAbstractListModel {
public:
    using QAbstractListModel::QAbstractListModel;

    void set(std::vector<Found> entries) {
        beginResetModel();
        entries_ = std::move(entries);
        endResetModel();
    }
    [[nodiscard]] const Found& at(const QModelIndex& index) const {
        return entries_[static_cast<std::size_t>(index.row())];
    }
    [[nodiscard]] int rowCount(const QModelIndex& parent = {}) const override {
        return parent.isValid() ? 0 : static_cast<int>(entries_.size());
    }
    [[nodiscard]] QVariant data(const QModelIndex& index, int role) const override {
        const auto& [action, menu, thing] = at(index);
        switch (role) {
        case Qt::DisplayRole:
            return action ? commandTitle(*action) : thing.title;
        case Qt::DecorationRole:
            if (!action && thing.icon.isEmpty()) return {};
            return action ? action->icon() : icon(thing.icon);
        case kShortcut:
            return action ? action->shortcut().toString(QKeySequence::NativeText) : QString();
        case kMenu:
            return action ? menu : thing.kind;
        default:
            return {};
        }
    }
    [[nodiscard]] Qt::ItemFlags flags(const QModelIndex& index) const override {
        const QAction* action = at(index).action;
        return !action || action->isEnabled() ? Qt::ItemIsEnabled | Qt::ItemIsSelectable
                                              : Qt::ItemFlags(Qt::ItemIsSelectable);
    }

private:
    std::vector<Found> entries_;
};

class CommandDelegate : public QStyledItemDelegate {
public:
    using QStyledItemDelegate::QStyledItemDelegate;

    [[nodiscard]] QSize sizeHint(const QStyleOptionViewItem&, const QModelIndex&) const override {
        return {100, kRowHeight};
    }
    void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override {
        const Palette& colors = currentPalette();
        const bool enabled = index.flags().testFlag(Qt::ItemIsEnabled);
        painter->save();
        painter->setRenderHint(QPainter::Antialiasing);
        const QRect row = option.rect.adjusted(0, 1, 0, -1);
        if (option.state.testFlag(QStyle::State_Selected)) {
            painter->setPen(Qt::NoPen);
            painter->setBrush(selectedColor(colors));
            painter->drawRoundedRect(row, 4, 4);
        }
        const QRect mark(row.left() + 10, row.center().y() - 8, 16, 16);
        index.data(Qt::DecorationRole)
            .value<QIcon>()
            .paint(painter, mark, Qt::AlignCenter, enabled ? QIcon::Normal : QIcon::Disabled);
        QRect text = row.adjusted(38, 0, -12, 0);
        const QString title = index.data().toString();
        painter->setPen(enabled ? colors.text : disabledText(colors));
        painter->drawText(text, Qt::AlignVCenter, title);
        const QString keys = index.data(kShortcut).toString();
        painter->setPen(enabled ? colors.textMuted : disabledText(colors));
        painter->drawText(text, Qt::AlignVCenter | Qt::AlignRight, keys);
        text.adjust(option.fontMetrics.horizontalAdvance(title) + 12, 0, 0, 0);
        painter->drawText(text, Qt::AlignVCenter, index.data(kMenu).toString());
        painter->restore();
    }
};

class CommandPalette : public Overlay {
public:
    CommandPalette(QWidget& window, Commands& commands) : Overlay(window), commands_(commands) {
        setObjectName("palette");
        makeCard();
        find({});
        connect(input_, &QLineEdit::textChanged, this, &CommandPalette::find);
        connect(list_, &QListView::clicked, this, &CommandPalette::run);
        input_->installEventFilter(this);
        input_->setFocus(Qt::PopupFocusReason);
    }

protected:
    bool eventFilter(QObject* watched, QEvent* event) override {
        if (watched == input_ && event->type() == QEvent::KeyPress && handleKey(*static_cast<QKeyEvent*>(event)))
            return true;
        return Overlay::eventFilter(watched, event);
    }
    void mousePressEvent(QMouseEvent* /*event*/) override { leave(); }
    void arrange() override {
        const int width = std::min(600, this->width() - 32);
        const int height = 62 + kRowHeight * std::clamp(model_.rowCount(), 1, kRows);
        card_->setGeometry((this->width() - width) / 2, std::min(96, this->height() / 8), width, height);
    }

private:
    void makeCard() {
        card_ = new QFrame(this);
        card_->setProperty("look", "popup");
        auto* column = new QVBoxLayout(card_);
        column->setContentsMargins(8, 8, 8, 8);
        column->setSpacing(8);
        input_ = new QLineEdit(card_);
        input_->setObjectName("palette.input");
        input_->setPlaceholderText("Type what you want to do, or the name of a thing");
        input_->addAction(icon("search", IconRole::muted), QLineEdit::LeadingPosition);
        input_->setProperty("look", "large");
        list_ = new QListView(card_);
        list_->setObjectName("palette.list");
        list_->setModel(&model_);
        list_->setItemDelegate(new CommandDelegate(list_));
        list_->setStyleSheet("QListView { background: transparent; border: none; }");
        list_->setFocusPolicy(Qt::NoFocus);
        list_->setUniformItemSizes(true);
        list_->setMouseTracking(true);
        column->addWidget(input_);
        column->addWidget(list_);
    }

    void find(const QString& typed) {
        model_.set(searchAll(commands_, typed));
        for (int row = 0; row < model_.rowCount(); ++row)
            if (model_.flags(model_.index(row)).testFlag(Qt::ItemIsEnabled)) {
                list_->setCurrentIndex(model_.index(row));
                break;
            }
        arrange();
    }

    bool handleKey(const QKeyEvent& key) {
        switch (key.key()) {
        case Qt::Key_Escape:
            leave();
            return true;
        case Qt::Key_Return:
        case Qt::Key_Enter:
            run(list_->currentIndex());
            return true;
        case Qt::Key_Down:
            move(1);
            return true;
        case Qt::Key_Up:
            move(-1);
            return true;
        case Qt::Key_PageDown:
            move(kRows);
            return true;
        case Qt::Key_PageUp:
            move(-kRows);
            return true;
        default:
            return false;
        }
    }

    void move(int rows) {
        if (model_.rowCount() == 0) return;
        const int to = std::clamp(list_->currentIndex().row() + rows, 0, model_.rowCount() - 1);
        list_->setCurrentIndex(model_.index(to));
    }

    void run(const QModelIndex& index) {
        if (!index.isValid()) return;
        const Found found = model_.at(index);
        if (!found.action) {
            Commands& commands = commands_; // this goes
            leave();
            commands.choose(found.thing);
            return;
        }
        const QPointer<QAction> action = found.action;
        if (!action->isEnabled()) return;
        leave();
        if (action) action->trigger();
    }

    Commands& commands_;
    CommandList model_;
    QFrame* card_ = nullptr;
    QLineEdit* input_ = nullptr;
    QListView* list_ = nullptr;
};

} // namespace

void toggleCommandPalette(QWidget& window, Commands& commands) {
    if (auto* open = window.findChild<QWidget*>("palette", Qt::FindDirectChildrenOnly)) {
        static_cast<CommandPalette*>(open)->leave();
        return;
    }
    window.activateWindow();
    (new CommandPalette(window, commands))->open();
}

} // namespace lumorph::studio
