#include "app/studio/shell/undo_commands.h"

#include <utility>

#include <QHBoxLayout>
#include <QLabel>
#include <QPointer>
#include <QPushButton>
#include <QTimer>

#include "app/studio/widgets/floating_card.h"

namespace lumorph::studio {
namespace {

constexpr int kToldMilliseconds = 4000;
constexpr int kAboveFoot = 44;

/// The workspace that shows what changed.
QString workspaceOf(StateParts parts) {
    if (parts & (StateParts(StatePart::scene) | StatePart::installation)) return "Scene";
    if (parts & (StateParts(StatePart::rig) | StatePart::rigEdited)) return "Rig";
    return "Field";
}

/// Over the foot of the window, for some seconds; it never takes the keyboard.
class UndoToast : public FloatingCard {
public:
    explicit UndoToast(QWidget& window) : FloatingCard(&window), text_(new QLabel(this)), show_(new QPushButton(this)) {
        setObjectName("undo.toast");
        text_->setObjectName("undo.toast.text");
        text_->setTextFormat(Qt::PlainText);
        show_->setObjectName("undo.toast.show");
        show_->setProperty("look", "link");
        show_->setFocusPolicy(Qt::TabFocus);
        auto* row = new QHBoxLayout(this);
        row->setContentsMargins(16, 8, 16, 8);
        row->setSpacing(16);
        row->addWidget(text_);
        row->addWidget(show_);
        end_.setSingleShot(true);
        connect(&end_, &QTimer::timeout, this, &QWidget::hide);
        connect(show_, &QPushButton::clicked, this, [this] {
            hide();
            if (const auto go = std::exchange(go_, {})) go();
        });
        hide();
    }
    void tell(const QString& what, const QString& place, std::function<void()> go) {
        text_->setText(what);
        setAccessibleName(what);
        go_ = std::move(go);
        show_->setVisible(go_ != nullptr);
        show_->setText("Show " + place);
        adjustSize();
        const QSize room = parentWidget()->size();
        move((room.width() - width()) / 2, room.height() - height() - kAboveFoot);
        show();
        raise();
        end_.start(kToldMilliseconds);
    }

private:
    QLabel* text_;
    QPushButton* show_;
    QTimer end_;
    std::function<void()> go_;
};

/// Does a step and tells it.
class UndoTeller : public QObject {
public:
    UndoTeller(Studio& studio, QMainWindow& window, QUndoGroup& stacks, std::function<QString()> present)
        : QObject(&window), studio_(studio), stacks_(stacks), present_(std::move(present)),
          toast_(new UndoToast(window)) {
        connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) { changed_ |= parts; });
    }
    void undo() {
        const QString what = stacks_.undoText();
        run([this] { stacks_.undo(); }, "Undone: ", what);
    }
    void redo() {
        const QString what = stacks_.redoText();
        run([this] { stacks_.redo(); }, "Done again: ", what);
    }

private:
    void run(const std::function<void()>& step, const QString& words, const QString& what) {
        const bool ofDocument = stacks_.activeStack() == &studio_.document.undoStack();
        changed_ = {};
        step();
        const QString here = present_();
        const QString place = ofDocument ? workspaceOf(changed_) : here;
        std::function<void()> go;
        if (QAction* command = place == here ? nullptr : commandOf(place)) go = [command] { command->trigger(); };
        toast_->tell(words + (what.isEmpty() ? QString("a step") : what) + " (" + place + ")", place, std::move(go));
    }
    [[nodiscard]] QAction* commandOf(const QString& workspace) const {
        for (const auto& entry : studio_.commands.all())
            if (entry.action->text() == workspace + " workspace") return entry.action;
        return nullptr;
    }

    Studio& studio_;
    QUndoGroup& stacks_;
    std::function<QString()> present_;
    UndoToast* toast_;
    StateParts changed_;
};

QAction* addUndoAction(Studio& studio, const char* id, const QString& text, const char* icon, const QKeySequence& keys,
                       std::function<void()> run) {
    Commands::Options options;
    options.icon = icon;
    options.shortcut = keys;
    options.menu = "Edit";
    return studio.commands.add(id, text, options, std::move(run));
}

} // namespace

void addUndoCommands(Studio& studio, QMainWindow& window, QUndoGroup& stacks, std::function<QString()> present) {
    auto* teller = new UndoTeller(studio, window, stacks, std::move(present));
    QAction* undo =
        addUndoAction(studio, "edit.undo", "&Undo", "undo", QKeySequence::Undo, [teller] { teller->undo(); });
    QAction* redo = addUndoAction(studio, "edit.redo", "&Redo", "redo", QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_Z),
                                  [teller] { teller->redo(); });
    // "Undo Move target", greyed while there is nothing to take back.
    const auto follow = [&stacks, undo, redo] {
        undo->setEnabled(stacks.canUndo());
        redo->setEnabled(stacks.canRedo());
        undo->setText(("&Undo " + stacks.undoText()).trimmed());
        redo->setText(("&Redo " + stacks.redoText()).trimmed());
    };
    QObject::connect(&stacks, &QUndoGroup::indexChanged, undo, follow);
    QObject::connect(&stacks, &QUndoGroup::canUndoChanged, undo, follow);
    QObject::connect(&stacks, &QUndoGroup::canRedoChanged, undo, follow);
    QObject::connect(&stacks, &QUndoGroup::activeStackChanged, undo, follow);
    follow();
}

} // namespace lumorph::studio
