#include "app/studio/base/operator_pin.h"

#include <algorithm>

#include <QPasswordDigestor>
#include <QRandomGenerator>

namespace lumorph::studio {
namespace {

constexpr auto kSaltKey = "kiosk/salt", kHashKey = "kiosk/hash", kWrongKey = "kiosk/wrongAttempts";
constexpr int kSaltWords = 4; ///< of 32 bits
constexpr int kRounds = 20'000;
constexpr quint64 kHashBytes = 32;
constexpr int kFreeAttempts = 5;
constexpr int kFirstPause = 30, kLongestPause = 15 * 60; ///< seconds

QByteArray hashOf(const QString& pin, const QByteArray& salt) {
    return QPasswordDigestor::deriveKeyPbkdf2(QCryptographicHash::Sha256, pin.toUtf8(), salt, kRounds, kHashBytes);
}

int pauseAfter(int wrongAttempts) {
    const int doublings = wrongAttempts - kFreeAttempts;
    if (doublings < 0) return 0;
    return doublings > 5 ? kLongestPause : std::min(kLongestPause, kFirstPause << doublings);
}

} // namespace

OperatorPin::OperatorPin(Settings& settings, const Clock& clock) : settings_(settings), clock_(clock) { pause(); }

bool OperatorPin::isSet() const {
    settings_.reload();
    return !settings_.value(kHashKey).toByteArray().isEmpty();
}

bool OperatorPin::choose(const QString& pin) {
    const bool digits = std::ranges::all_of(pin, [](QChar one) { return one >= '0' && one <= '9'; });
    if (!digits || pin.size() < kFewestDigits || pin.size() > kMostDigits) return false;
    QByteArray salt;
    for (int word = 0; word < kSaltWords; ++word)
        salt += QByteArray::number(QRandomGenerator::system()->generate(), 16).rightJustified(8, '0');
    settings_.setValue(kSaltKey, salt);
    settings_.setValue(kHashKey, hashOf(pin, salt).toHex());
    settings_.setValue(kWrongKey, 0);
    pause();
    return true;
}

OperatorPin::Answer OperatorPin::attempt(const QString& pin) {
    if (!isSet()) return Answer::wrong; // nothing to guess, so nothing is counted
    if (secondsToWait() > 0) return Answer::paused;
    const QByteArray kept = settings_.value(kHashKey).toByteArray();
    const bool right = hashOf(pin, settings_.value(kSaltKey).toByteArray()).toHex() == kept;
    settings_.setValue(kWrongKey, right ? 0 : wrongAttempts() + 1);
    pause();
    return right ? Answer::right : Answer::wrong;
}

int OperatorPin::wrongAttempts() const { return std::max(0, settings_.value(kWrongKey, 0).toInt()); }

void OperatorPin::pause() { pausedUntil_ = clock_.now() + std::chrono::seconds(pauseAfter(wrongAttempts())); }

int OperatorPin::secondsToWait() const {
    const auto left = pausedUntil_ - clock_.now();
    return static_cast<int>(std::max<long long>(0, std::chrono::ceil<std::chrono::seconds>(left).count()));
}

void OperatorPin::forget(Settings& settings) {
    for (const char* key : {kSaltKey, kHashKey, kWrongKey}) settings.remove(key);
    settings.reload();
}

} // namespace lumorph::studio
