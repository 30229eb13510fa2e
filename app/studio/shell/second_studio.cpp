#include "app/studio/shell/second_studio.h"

#include "app/studio/shell/kept_work_list.h"

namespace lumorph::studio {
namespace {

constexpr auto kHomeNotices = "home";

QString otherStudioSubject() { return QObject::tr("Another Lumorph is open"); }

QString sinceWords(const Studio& studio) {
    const auto since = studio.home.first() ? studio.project.otherSince() : studio.home.otherSince();
    return since ? QObject::tr(", since %1").arg(timeWords(*since)) : QString();
}

void postTookOver(Studio& studio) {
    studio.notices.dismiss(kHomeNotices, otherStudioSubject());
    studio.notices.post(kHomeNotices, {Notice::Level::info,
                                       QObject::tr("The other Lumorph has ended"),
                                       QObject::tr("this window has taken over: its session, settings and the room's "
                                                   "calibration are kept as usual"),
                                       QObject::tr("unsaved work of the other one is in File, Bring back unsaved work"),
                                       {}});
}

} // namespace

bool isSecond(const Studio& studio) { return !studio.home.first() || !studio.project.keepsSession(); }

void postOtherStudio(Studio& studio) {
    if (!isSecond(studio)) return;
    const QString session =
        studio.project.keepsSession() ? QString() : QObject::tr("This window keeps a session of its own. ");
    const QString room = studio.home.first()
                             ? QString()
                             : QObject::tr("The room's calibration, device profiles and settings are read only here "
                                           "until it ends: changes count in this window alone");
    studio.notices.post(kHomeNotices, {Notice::Level::warning,
                                       otherStudioSubject(),
                                       QObject::tr("on this computer%1. %2%3").arg(sinceWords(studio), session, room),
                                       QObject::tr("work there; or end it, and this window takes over"),
                                       {}});
}

void reportOtherStudio(Studio& studio, QObject& owner) {
    if (!isSecond(studio)) return;
    postOtherStudio(studio);
    const auto follow = [&studio] { isSecond(studio) ? postOtherStudio(studio) : postTookOver(studio); };
    QObject::connect(&studio.home, &StudioHome::tookOver, &owner, follow);
    QObject::connect(&studio.project, &ProjectService::tookOver, &owner, follow);
}

} // namespace lumorph::studio
