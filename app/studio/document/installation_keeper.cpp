#include "app/studio/document/installation_keeper.h"

#include <algorithm>
#include <utility>

#include <QCoreApplication>
#include <QCryptographicHash>
#include <QFileInfo>

namespace lumorph::studio {
namespace {

constexpr int kEditsRestMilliseconds = 1000; // edits come in bursts
constexpr auto kAnsweredKey = "installation/answered";
constexpr int kMostAnswers = 100;
constexpr auto kPlace = "project";
constexpr auto kHomePlace = "home";      // where a second studio is reported
constexpr auto kQuestionPlace = "scene"; // where projector and table are seen

QString subject() { return QObject::tr("Installation"); }

/// Of a project's copy beside the room's own.
QString questionOf(const Installation& project, const Installation& room) {
    QCryptographicHash hash(QCryptographicHash::Sha1);
    for (const Installation* one : {&project, &room})
        hash.addData(QByteArray::fromStdString(installationText(figuresOf(*one))));
    return QString::fromLatin1(hash.result().toHex());
}

} // namespace

InstallationKeeper::InstallationKeeper(Settings& settings, StudioDocument& document, ProjectService& projects,
                                       Notices& notices)
    : settings_(settings), document_(document), notices_(notices), store_(settings.folder() / "installation") {
    load();
    writer_ = std::make_unique<InstallationWriter>(
        [store = store_](const Installation& installation) mutable { store.keep(installation); },
        [this](std::shared_ptr<const Installation> written, const std::exception_ptr& failure) {
            QMetaObject::invokeMethod(
                this, [this, written = std::move(written), failure] { takeWritten(written, failure); },
                Qt::QueuedConnection);
        });
    due_.setSingleShot(true);
    due_.setInterval(kEditsRestMilliseconds);
    connect(&due_, &QTimer::timeout, this, &InstallationKeeper::keep);
    connect(&document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (!(parts & StatePart::installation)) return;
        if (!document_.previewing()) settled_ = document_.state().installation;
        due_.start();
    });
    connect(&projects, &ProjectService::openedElsewhere, this, &InstallationKeeper::compare);
    connect(&settings, &Settings::readOnlyChanged, this, [this] {
        if (!settings_.readOnly()) takeOver();
    });
}

InstallationKeeper::~InstallationKeeper() {
    if (due_.isActive()) offer();
    writer_.reset();
    QCoreApplication::sendPostedEvents(this, QEvent::MetaCall); // notices of what it could not write
}

void InstallationKeeper::load() {
    try {
        if (auto installation = store_.load())
            document_.setInstallation(std::make_shared<const Installation>(*std::move(installation)));
    } catch (const std::exception& error) {
        Notice notice = noticeOf(error);
        notice.why = tr("what stands in the room could not be read: %1").arg(notice.why);
        notice.remedy = tr("the virtual lab's installation is in use until you bring an earlier one back");
        if (const auto files = earlier(); !files.empty())
            notice.actions.push_back(
                {tr("Bring back the last one"), [this, file = files.front()] { bringBack(file); }});
        notices_.post(kPlace, notice);
    }
    kept_ = offered_ = settled_ = document_.state().installation;
}

/// The other studio may have measured the room meanwhile, so its figures come first.
void InstallationKeeper::takeOver() {
    due_.stop();
    const auto mine = document_.state().installation;
    const bool changed = !isSameRoom(*mine, *kept_);
    load();
    notices_.dismiss(kHomePlace, subject());
    emit versionsChanged();
    if (!changed || isSameRoom(*mine, *document_.state().installation)) return;
    notices_.post(kHomePlace, {Notice::Level::info,
                               subject(),
                               tr("the room's own figures are in use again"),
                               tr("those that were changed in this window can take their place"),
                               {{tr("Use this window's"), [this, mine] {
                                     take(*mine, "another window", tr("Use this window's installation"));
                                 }}}});
}

void InstallationKeeper::reportReadOnly() {
    notices_.post(kHomePlace, {Notice::Level::warning,
                               subject(),
                               tr("another Lumorph has the room: this change counts in this window alone"),
                               tr("end the other one first; then it can be kept"),
                               {}});
}

void InstallationKeeper::keep() {
    if (document_.previewing()) { // where a drag ends is what counts
        due_.start();
        return;
    }
    settled_ = document_.state().installation;
    offer();
}

void InstallationKeeper::offer() {
    if (settled_ == offered_ || *settled_ == *offered_) return;
    if (settings_.readOnly()) return reportReadOnly();
    offered_ = settled_;
    writer_->offer(offered_);
}

/// What the writer has done.
void InstallationKeeper::takeWritten(const std::shared_ptr<const Installation>& written,
                                     const std::exception_ptr& failure) {
    const bool isNewest = written == offered_;
    if (!failure) {
        kept_ = written;
        if (isNewest) notices_.dismiss(kPlace, subject());
        return;
    }
    if (!isNewest) return; // the newer one is tried by itself
    offered_ = kept_;
    try {
        std::rethrow_exception(failure);
    } catch (const std::exception& error) {
        Notice notice = noticeOf(error);
        notice.why = tr("what stands in the room could not be kept for the next start: %1").arg(notice.why);
        notice.subject = subject();
        notice.actions.push_back({tr("Try again"), [this] { keep(); }});
        notices_.post(kPlace, notice);
    }
}

void InstallationKeeper::bringBack(const std::filesystem::path& file) {
    try {
        take(InstallationStore::read(file), "an earlier installation", tr("Bring back an earlier installation"));
    } catch (const std::exception& error) {
        notices_.post(kPlace, noticeOf(error));
    }
}

bool InstallationKeeper::takeVersion(InstallationVersion version) {
    const Installation& room = *document_.state().installation;
    if (version.date.empty()) version.date = utcDate();
    if (settings_.readOnly()) {
        reportReadOnly();
        return false;
    }
    try {
        checkInstallation(version.installation);
        const std::vector<KeptVersion> kept = versions();
        if (std::ranges::none_of(kept, [&](const KeptVersion& one) { return isCurrent(one.version); }))
            store_.keepVersion({version.date, tr("As it stood before").toStdString(), {}, {}, {}, room, false});
        store_.keepVersion(version);
    } catch (const std::exception& error) {
        Notice notice = noticeOf(error);
        notice.why = tr("the result could not be kept: %1").arg(notice.why);
        notice.subject = subject();
        notices_.post(kPlace, notice);
        return false;
    }
    const QString what = QString::fromStdString(version.title);
    take(std::move(version.installation), version.title, what);
    emit versionsChanged();
    return true;
}

bool InstallationKeeper::isCurrent(const InstallationVersion& version) const {
    return isSameRoom(version.installation, *document_.state().installation);
}

void InstallationKeeper::bringBackVersion(const std::filesystem::path& file) {
    try {
        InstallationVersion version = InstallationStore::readVersion(file);
        take(std::move(version.installation), version.title,
             tr("Bring back: %1").arg(QString::fromStdString(version.title)));
    } catch (const std::exception& error) {
        notices_.post(kPlace, noticeOf(error));
    }
    emit versionsChanged();
}

void InstallationKeeper::removeVersion(const std::filesystem::path& file) {
    if (settings_.readOnly()) return reportReadOnly();
    try {
        InstallationStore::removeVersion(file);
    } catch (const std::exception& error) {
        notices_.post(kPlace, noticeOf(error));
    }
    emit versionsChanged();
}

/// Opening a project changes nothing in the room. One that comes from elsewhere has its own figures, which may be what
/// its maker wants on another machine in the same room, or of no use at all here: only the user knows.
void InstallationKeeper::compare(const QString& project, const std::shared_ptr<const Installation>& installation) {
    notices_.dismiss(kQuestionPlace, subject());
    // A project that only ever saw the virtual lab has nothing to offer.
    if (!installation || isSameRoom(*installation, *document_.state().installation) ||
        isSameRoom(*installation, defaultInstallation()))
        return;
    const QString question = questionOf(*installation, *document_.state().installation);
    if (answered(question)) return;
    const QString name = QFileInfo(project).fileName();
    notices_.post(kQuestionPlace, {Notice::Level::info,
                                   subject(),
                                   tr("other projectors, or another table: %1").arg(name),
                                   tr("this room's stay in use"),
                                   {{tr("Keep"), [this, question] { setAnswered(question); }},
                                    {tr("Use its"), [this, question, installation, name] {
                                         setAnswered(question);
                                         take(*installation, "project " + name.toStdString(),
                                              tr("Use the installation of %1").arg(name));
                                     }}}});
}

/// What is taken over keeps the origins that it has; what nobody had looked at came from there.
void InstallationKeeper::take(Installation installation, const std::string& from, const QString& what) {
    markOrigins(*document_.state().installation, installation, {Origin::Way::entered, from, utcDate()});
    auto taken = std::make_shared<const Installation>(std::move(installation));
    document_.change(what, [&](StudioState& state) { state.installation = taken; });
}

bool InstallationKeeper::answered(const QString& question) const {
    return settings_.value(kAnsweredKey).toStringList().contains(question);
}

void InstallationKeeper::setAnswered(const QString& question) {
    QStringList answers = settings_.value(kAnsweredKey).toStringList();
    answers.removeAll(question);
    answers.prepend(question);
    settings_.setValue(kAnsweredKey, answers.mid(0, kMostAnswers));
}

} // namespace lumorph::studio
