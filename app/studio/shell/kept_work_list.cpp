#include "app/studio/shell/kept_work_list.h"

#include <algorithm>

#include <QDialog>
#include <QDialogButtonBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLocale>
#include <QPushButton>
#include <QScrollArea>
#include <QVBoxLayout>

#include "app/applications/registry/demos.h"

namespace lumorph::studio {
namespace {

constexpr std::size_t kMany = 20;
constexpr std::uintmax_t kLarge = 1'000'000'000; // bytes
constexpr QSize kSize{620, 440};

std::uintmax_t bytesOf(const std::vector<KeptWork>& all) {
    std::uintmax_t bytes = 0;
    for (const KeptWork& work : all) bytes += work.bytes;
    return bytes;
}

QString sizeWords(std::uintmax_t bytes) {
    return QLocale().formattedDataSize(static_cast<qint64>(bytes), 1, QLocale::DataSizeSIFormat);
}

QLabel* makeText(const QString& text, const char* look, QWidget* parent) {
    auto* label = new QLabel(text, parent);
    label->setTextFormat(Qt::PlainText); // a file's name is no markup
    label->setWordWrap(true);
    label->setProperty("look", look);
    return label;
}

/// A row for each, the newest first.
class KeptWorkList : public QDialog {
public:
    KeptWorkList(Studio& studio, QWidget* window) : QDialog(window), studio_(studio) {
        setObjectName("dialog.keptWork");
        setWindowTitle(say({"Unsaved work that is kept", "Nicht gespeicherte Arbeiten"}));
        setAttribute(Qt::WA_DeleteOnClose);
        auto* column = new QVBoxLayout(this);
        column->setContentsMargins(24, 16, 24, 16);
        column->setSpacing(12);
        column->addWidget(makeText(say({"What was edited and not saved when something else was opened. It stays here "
                                        "until you bring it back or throw it away, also after a restart.",
                                        "Was bearbeitet und nicht gespeichert war, als etwas anderes geöffnet wurde. "
                                        "Es bleibt hier, bis du es zurückholst oder verwirfst, auch nach einem "
                                        "Neustart."}),
                                   "muted", this));
        area_ = new QScrollArea(this);
        area_->setWidgetResizable(true);
        area_->setFrameShape(QFrame::NoFrame);
        area_->setFocusPolicy(Qt::NoFocus);
        column->addWidget(area_, 1);
        auto* foot = new QHBoxLayout;
        sum_ = makeText({}, "muted", this);
        sum_->setObjectName("keptWork.sum");
        foot->addWidget(sum_, 1);
        auto* close = new QPushButton(say({"Close", "Schließen"}), this);
        close->setObjectName("keptWork.close");
        connect(close, &QPushButton::clicked, this, &QDialog::close);
        foot->addWidget(close);
        column->addLayout(foot);
        connect(&studio.project, &ProjectService::keptWorkChanged, this, [this] { fill(); });
        fill();
    }

private:
    [[nodiscard]] QString say(const Words& words) const { return studio_.settings.say(words); }

    void fill() {
        auto* content = new QWidget;
        content->setProperty("look", "column");
        auto* column = new QVBoxLayout(content);
        column->setContentsMargins(0, 0, 0, 0);
        column->setSpacing(8);
        const std::vector<KeptWork> all = studio_.project.keptWork();
        for (const KeptWork& work : all) column->addWidget(makeRow(work, content));
        if (all.empty()) column->addWidget(makeText(say({"There is none.", "Es gibt keine."}), "muted", content));
        column->addStretch(1);
        // The old rows go only after the click on one of them.
        if (QWidget* old = area_->takeWidget()) {
            old->hide();
            old->deleteLater();
        }
        area_->setWidget(content);
        sum_->setText(all.empty()
                          ? QString()
                          : say({"%1 kept, %2 on the disk", "%1 aufbewahrt, %2 auf der Platte"})
                                .arg(QLocale().toString(static_cast<qulonglong>(all.size())), sizeWords(bytesOf(all))));
    }

    QWidget* makeRow(const KeptWork& work, QWidget* parent) {
        auto* row = new QFrame(parent);
        row->setObjectName("keptWork.row");
        row->setProperty("look", "card");
        auto* line = new QHBoxLayout(row);
        line->setContentsMargins(12, 8, 8, 8);
        line->setSpacing(8);
        auto* texts = new QVBoxLayout;
        texts->setSpacing(2);
        texts->addWidget(makeText(nameOf(work, studio_.settings.language()), "heading", row));
        texts->addWidget(makeText(detailOf(work), "muted", row));
        line->addLayout(texts, 1);
        const auto add = [&](const char* name, const QString& text, const char* look, std::function<void()> run) {
            auto* button = new QPushButton(text, row);
            button->setObjectName(name);
            button->setProperty("look", look);
            button->setAutoDefault(false);
            button->setAccessibleName(text + ": " + nameOf(work, studio_.settings.language()));
            connect(button, &QPushButton::clicked, &studio_.project, std::move(run));
            line->addWidget(button, 0, Qt::AlignVCenter);
        };
        ProjectService& project = studio_.project;
        if (work.thrown) {
            add("keptWork.undo", say({"Undo", "Rückgängig"}), "",
                [&project, id = work.id] { project.setThrown(id, false); });
            return row;
        }
        add("keptWork.throw", say({"Throw away", "Verwerfen"}), "",
            [&project, id = work.id] { project.setThrown(id, true); });
        add("keptWork.bringBack", say({"Bring back", "Zurückholen"}), "primary", [this, &project, work] {
            close();
            const auto demo = std::ranges::find(demos(), work.demo, &Demo::name);
            if (demo != demos().end()) emit studio_.commands.workspaceWanted(QString::fromStdString(demo->workspace));
            project.bringBack(work.id);
        });
        return row;
    }

    [[nodiscard]] QString detailOf(const KeptWork& work) const {
        QStringList parts{timeWords(work.when)};
        if (work.thrown)
            parts << say({"thrown away, for good tomorrow", "verworfen, endgültig ab morgen"});
        else if (work.edits > 0 && !work.lastEdit.empty())
            parts << say({"edited, last: %1", "bearbeitet, zuletzt: %1"}).arg(QString::fromStdString(work.lastEdit));
        else
            parts << say({"edited", "bearbeitet"});
        parts << sizeWords(work.bytes);
        return parts.join(", ");
    }

    Studio& studio_;
    QScrollArea* area_ = nullptr;
    QLabel* sum_ = nullptr;
};

void reportSpace(Studio& studio, QWidget& window) {
    const std::vector<KeptWork> all = studio.project.keptWork();
    const QString subject = QObject::tr("Kept work");
    if (all.size() < kMany && bytesOf(all) < kLarge) return studio.notices.dismiss("home", subject);
    studio.notices.post("home",
                        {Notice::Level::info,
                         subject,
                         QObject::tr("%1 unsaved works take %2; none is removed by itself")
                             .arg(QLocale().toString(static_cast<qulonglong>(all.size())), sizeWords(bytesOf(all))),
                         QObject::tr("throw away what you no longer need"),
                         {{QObject::tr("Show them"), [&studio, &window] { openKeptWork(studio, window); }}}});
}

} // namespace

QString nameOf(const KeptWork& work, Language language) {
    const auto demo = std::ranges::find(demos(), work.demo, &Demo::name);
    return QString::fromStdString(demo != demos().end() ? demo->title.in(language) : work.name);
}

QString timeWords(const QDateTime& time) {
    const QDateTime when = time.toLocalTime();
    const QString clock = when.toString("HH:mm");
    if (when.date() == QDate::currentDate()) return clock;
    return QLocale().toString(when.date(), QLocale::ShortFormat) + ' ' + clock;
}

void openKeptWork(Studio& studio, QWidget& window) {
    if (auto* open = window.findChild<QDialog*>("dialog.keptWork")) return open->raise();
    auto* dialog = new KeptWorkList(studio, &window);
    dialog->resize(kSize.boundedTo(window.size() * 0.95));
    dialog->show();
}

void addKeptWorkCommand(Studio& studio, QWidget& window) {
    Commands::Options options;
    options.icon = "clock";
    options.menu = "File";
    QAction* action = studio.commands.add("file.bringBack", "&Bring back unsaved work...", options,
                                          [&studio, &window] { openKeptWork(studio, window); });
    action->setToolTip("What was edited and not saved when something else was opened; it is kept until you bring it "
                       "back or throw it away");
    const auto follow = [&studio, &window, action] {
        action->setEnabled(!studio.project.keptWork().empty());
        reportSpace(studio, window);
    };
    QObject::connect(&studio.project, &ProjectService::keptWorkChanged, action, follow);
    follow();
}

} // namespace lumorph::studio
