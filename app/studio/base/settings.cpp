#include "app/studio/base/settings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QFileInfo>
#include <QLocale>

namespace lumorph::studio {
namespace {

constexpr int kMostRecentFiles = 10;
constexpr double kLowestRate = 10.0, kHighestRate = 120.0, kUsualRate = 60.0;
constexpr double kUsualLoudness = 0.7;
constexpr double kLeastBareShare = 0.15, kMostBareShare = 0.4;

constexpr double kUsualNextMinutes = 2.0, kMostNextMinutes = 120.0; // in the kiosk

QString nextKey(bool kiosk) { return kiosk ? "visitors/nextInKiosk" : "visitors/next"; }

QString toldKey(const std::string& demo) { return "applications/told/" + QString::fromStdString(demo); }

QString layoutKey(const QString& workspace) { return "layout/" + workspace; }

} // namespace

Settings::Settings(QObject* parent)
    : QObject(parent), store_(QSettings::IniFormat, QSettings::UserScope, "lumorph", "studio") {}

Theme Settings::theme() const { return value("look/theme").toString() == "light" ? Theme::light : Theme::dark; }

void Settings::setTheme(Theme theme) {
    if (theme == this->theme()) return;
    setValue("look/theme", theme == Theme::light ? "light" : "dark");
    emit themeChanged();
}

double Settings::loopRate() const {
    bool isNumber = false;
    const double rate = value("loop/rate", kUsualRate).toDouble(&isNumber);
    return isNumber ? std::clamp(rate, kLowestRate, kHighestRate) : kUsualRate; // the file may be edited by hand
}

void Settings::setLoopRate(double framesPerSecond) {
    const double rate = std::clamp(framesPerSecond, kLowestRate, kHighestRate);
    if (rate == loopRate()) return;
    setValue("loop/rate", rate);
    emit loopRateChanged();
}

bool Settings::stillQuality() const { return value("look/stillQuality", true).toBool(); }

void Settings::setStillQuality(bool on) {
    if (on == stillQuality()) return;
    setValue("look/stillQuality", on);
    emit qualityChanged();
}

bool Settings::placesNewTargets() const { return value("target/placeNew", true).toBool(); }

void Settings::setPlacesNewTargets(bool on) {
    if (on == placesNewTargets()) return;
    setValue("target/placeNew", on);
    emit placesNewTargetsChanged();
}

bool Settings::sound() const { return value("sound/on", true).toBool(); }

void Settings::setSound(bool on) {
    if (on == sound()) return;
    setValue("sound/on", on);
    emit soundChanged();
}

double Settings::loudness() const {
    bool isNumber = false;
    const double share = value("sound/loudness", kUsualLoudness).toDouble(&isNumber);
    return isNumber ? std::clamp(share, 0.0, 1.0) : kUsualLoudness;
}

void Settings::setLoudness(double share) {
    const double tenths = std::round(10.0 * std::clamp(share, 0.0, 1.0)) / 10.0;
    if (tenths == loudness()) return;
    setValue("sound/loudness", tenths);
    emit soundChanged();
}

BareInlay Settings::bareInlay() const {
    BareInlay inlay;
    bool isNumber = false;
    const int corner = value("visitors/bareCorner").toInt(&isNumber);
    if (isNumber && corner >= 0 && corner <= static_cast<int>(BareInlay::Corner::bottomLeft))
        inlay.corner = static_cast<BareInlay::Corner>(corner);
    const double share = value("visitors/bareShare").toDouble(&isNumber);
    if (isNumber) inlay.share = std::clamp(share, kLeastBareShare, kMostBareShare);
    return inlay;
}

void Settings::setBareInlay(const BareInlay& inlay) {
    if (inlay == bareInlay()) return;
    setValue("visitors/bareCorner", static_cast<int>(inlay.corner));
    setValue("visitors/bareShare", std::clamp(inlay.share, kLeastBareShare, kMostBareShare));
    emit bareInlayChanged();
}

bool Settings::tourSeen() const { return value("tour/seen", false).toBool(); }

void Settings::setTourSeen(bool seen) { setValue("tour/seen", seen); }

Language Settings::language() const {
    const QString chosen = value("visitors/language").toString();
    if (chosen == "de") return Language::german;
    if (chosen == "en") return Language::english;
    return QLocale::system().language() == QLocale::German ? Language::german : Language::english;
}

void Settings::setLanguage(Language language) {
    const bool other = language != this->language();
    setValue("visitors/language", language == Language::german ? "de" : "en");
    if (other) emit languageChanged();
}

QString Settings::say(const Words& words) const { return QString::fromStdString(words.in(language())); }

std::map<std::string, std::string> Settings::toldTo(const std::string& demo) const {
    std::map<std::string, std::string> told;
    const QVariantMap kept = value(toldKey(demo)).toMap();
    for (auto at = kept.begin(); at != kept.end(); ++at) told[at.key().toStdString()] = at->toString().toStdString();
    return told;
}

void Settings::setToldTo(const std::string& demo, const std::map<std::string, std::string>& told) {
    QVariantMap kept;
    for (const auto& [name, text] : told) kept[QString::fromStdString(name)] = QString::fromStdString(text);
    if (kept.isEmpty())
        remove(toldKey(demo));
    else
        setValue(toldKey(demo), kept);
}

double Settings::nextMinutes(bool kiosk) const {
    const double usual = kiosk ? kUsualNextMinutes : 0.0;
    bool isNumber = false;
    const double minutes = value(nextKey(kiosk), usual).toDouble(&isNumber);
    return isNumber ? std::clamp(minutes, 0.0, kMostNextMinutes) : usual;
}

void Settings::setNextMinutes(bool kiosk, double minutes) { setValue(nextKey(kiosk), minutes); }

QStringList Settings::recentFiles() const {
    QStringList there;
    for (const QString& path : value("files/recent").toStringList())
        if (there.size() < kMostRecentFiles && QFileInfo::exists(path)) there << path;
    return there;
}

void Settings::addRecentFile(const QString& path) {
    const QString absolute = QFileInfo(path).absoluteFilePath();
    QStringList files = value("files/recent").toStringList();
    files.removeAll(absolute);
    files.prepend(absolute);
    setValue("files/recent", QStringList(files.mid(0, 2 * kMostRecentFiles)));
    emit recentFilesChanged();
}

void Settings::clearRecentFiles() {
    remove("files/recent");
    emit recentFilesChanged();
}

QByteArray Settings::layout(const QString& workspace) const { return value(layoutKey(workspace)).toByteArray(); }

void Settings::setLayout(const QString& workspace, const QByteArray& layout) { setValue(layoutKey(workspace), layout); }

std::filesystem::path Settings::folder() const { return QFileInfo(store_.fileName()).absolutePath().toStdString(); }

QVariant Settings::value(const QString& key, const QVariant& fallback) const {
    if (const auto own = unwritten_.find(key); own != unwritten_.end()) return own->second.value_or(fallback);
    return store_.value(key, fallback);
}

void Settings::setValue(const QString& key, const QVariant& value) {
    if (readOnly_)
        unwritten_[key] = value;
    else
        store_.setValue(key, value);
}

void Settings::remove(const QString& key) {
    if (readOnly_)
        unwritten_[key] = std::nullopt;
    else
        store_.remove(key);
}

void Settings::setReadOnly(bool readOnly) {
    if (readOnly == readOnly_) return;
    readOnly_ = readOnly;
    if (!readOnly) {
        store_.sync(); // what the other program wrote, below what was chosen here
        for (const auto& [key, value] : std::exchange(unwritten_, {}))
            value ? store_.setValue(key, *value) : store_.remove(key);
    }
    emit readOnlyChanged();
}

void Settings::reload() { store_.sync(); }

} // namespace lumorph::studio
