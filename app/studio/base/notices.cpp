#include "app/studio/base/notices.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <set>

#include "core/base/error.h"

namespace lumorph::studio {

namespace {

/// Where a notice stands says which folder is meant; the file's name is what a user looks for.
QString shortSubject(const std::string& subject) {
    const std::filesystem::path path(subject);
    return QString::fromStdString(path.is_absolute() && path.has_filename() ? path.filename().string() : subject);
}

} // namespace

Notice noticeOf(const std::exception& error) {
    Notice notice;
    if (const auto* known = dynamic_cast<const Error*>(&error)) {
        notice.subject = shortSubject(known->subject());
        notice.why = QString::fromStdString(known->why());
        notice.remedy = QString::fromStdString(known->remedy());
    } else if (dynamic_cast<const std::bad_alloc*>(&error)) {
        notice.subject = Notices::tr("Memory");
        notice.why = Notices::tr("there is not enough of it for this");
        notice.remedy = Notices::tr("close other programs, or use a smaller file or a lower resolution");
    } else {
        notice.subject = Notices::tr("Lumorph");
        notice.why = QString::fromUtf8(error.what());
    }
    return notice;
}

void Notices::post(const QString& place, Notice notice) {
    std::erase_if(entries_, [&](const Entry& e) { return e.place == place && e.notice.subject == notice.subject; });
    entries_.insert(entries_.begin(), Entry{place, std::move(notice)});
    emit changed(place);
    emit posted(place);
}

void Notices::dismiss(const QString& place, const QString& subject) {
    // Names may belong to the very notice that goes away.
    const QString at = place, about = subject;
    if (std::erase_if(entries_, [&](const Entry& e) { return e.place == at && e.notice.subject == about; }) > 0)
        emit changed(at);
}

void Notices::dismissAll(const QString& place) {
    const QString at = place;
    std::set<QString> places;
    std::erase_if(entries_, [&](const Entry& e) {
        const bool goes = at.isEmpty() || e.place == at;
        if (goes) places.insert(e.place);
        return goes;
    });
    for (const QString& changedPlace : places) emit changed(changedPlace);
}

std::vector<Notice> Notices::at(const QString& place) const {
    std::vector<Notice> found;
    for (const Entry& entry : entries_)
        if (place.isEmpty() || entry.place == place) found.push_back(entry.notice);
    return found;
}

} // namespace lumorph::studio
