#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include <QObject>
#include <QSettings>
#include <QString>
#include <QStringList>

#include "core/base/clock.h"
#include "core/base/words.h"
#include "core/render/viewport/theme.h"

namespace lumorph::studio {

/// Where visitors see the bare device beside the picture; in the other corners are words and buttons.
struct BareInlay {
    enum class Corner { none, topRight, bottomLeft };
    Corner corner = Corner::topRight;
    double share = 0.26; ///< of the view's width
    bool operator==(const BareInlay&) const = default;
};

/// What the user chose once for all projects; kept in the user's configuration. Lives in the window's thread.
class Settings : public QObject {
    Q_OBJECT
public:
    explicit Settings(QObject* parent = nullptr);

    [[nodiscard]] Theme theme() const;
    void setTheme(Theme theme);
    [[nodiscard]] double loopRate() const; ///< frames a second, 10 to 120
    void setLoopRate(double framesPerSecond);
    [[nodiscard]] bool stillQuality() const; ///< draw a still view in full quality
    void setStillQuality(bool on);
    [[nodiscard]] bool placesNewTargets() const; ///< a new target is moved where it matches best
    void setPlacesNewTargets(bool on);
    [[nodiscard]] bool sound() const; ///< applications may be heard
    void setSound(bool on);
    [[nodiscard]] double loudness() const; ///< 0 to 1, in steps of a tenth
    void setLoudness(double share);
    [[nodiscard]] BareInlay bareInlay() const;
    void setBareInlay(const BareInlay& inlay);
    [[nodiscard]] bool tourSeen() const;
    void setTourSeen(bool seen);
    /// That of visitors; as long as none was chosen, the system's where it is one of them, else English.
    [[nodiscard]] Language language() const;
    void setLanguage(Language language);
    /// A text in that language.
    [[nodiscard]] QString say(const Words& words) const;
    /// What the host wants a demonstration to be told, by the names of its options.
    [[nodiscard]] std::map<std::string, std::string> toldTo(const std::string& demo) const;
    void setToldTo(const std::string& demo, const std::map<std::string, std::string>& told);
    /// Minutes without a visitor after which the next application shows; 0: it stays.
    [[nodiscard]] double nextMinutes(bool kiosk) const; ///< 2 in the kiosk and 0 outside, as long as none were chosen
    void setNextMinutes(bool kiosk, double minutes);
    [[nodiscard]] QStringList recentFiles() const; ///< newest first, at most ten, those that are still there
    void addRecentFile(const QString& path);
    void clearRecentFiles();
    [[nodiscard]] QByteArray layout(const QString& workspace) const;
    void setLayout(const QString& workspace, const QByteArray& layout);
    /// Where what is too large for a setting lies: the folder of the settings' own file.
    [[nodiscard]] std::filesystem::path folder() const;
    [[nodiscard]] QVariant value(const QString& key, const QVariant& fallback = {}) const;
    void setValue(const QString& key, const QVariant& value);
    void remove(const QString& key);
    /// Writes what changed here and reads what another process changed.
    void reload();
    /// While another program writes them: what is chosen here counts for this one, and is written once it may be.
    void setReadOnly(bool readOnly);
    [[nodiscard]] bool readOnly() const noexcept { return readOnly_; }

signals:
    void themeChanged();
    void loopRateChanged();
    void qualityChanged();
    void placesNewTargetsChanged();
    void languageChanged();
    void soundChanged();
    void bareInlayChanged();
    void recentFilesChanged();
    void readOnlyChanged();

private:
    QSettings store_;
    bool readOnly_ = false;
    std::map<QString, std::optional<QVariant>> unwritten_; ///< while read only; empty: removed
};

} // namespace lumorph::studio
