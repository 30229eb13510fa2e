#include "app/studio/widgets/quantity.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <QLocale>
#include <QRegularExpression>
#include <QStringList>

namespace lumorph::studio {
namespace {

struct Unit {
    QString name;
    double si = 1.0;
    bool told = true; ///< to the user; others are spellings of one that is
};

constexpr double kDegree = std::numbers::pi / 180.0;
const QString kDegreeSign(QChar(0x00B0));
const QString kCubed(QChar(0x00B3));

/// The quantity's own unit comes first.
std::vector<Unit> units(Quantity quantity) {
    const QString micro(QChar(0x00B5)), greekMu(QChar(0x03BC));
    switch (quantity) {
    case Quantity::plain:
    case Quantity::level:
        return {{"", 1.0, false}};
    case Quantity::length:
        return {{"cm", 1e-2},
                {"mm", 1e-3},
                {"m", 1.0},
                {"um", 1e-6, false},
                {"in", 0.0254},
                {"\"", 0.0254, false},
                {"ft", 0.3048},
                {"'", 0.3048, false},
                {micro + "m", 1e-6, false},
                {greekMu + "m", 1e-6, false}};
    case Quantity::angle:
        return {{kDegreeSign, kDegree, false},
                {"deg", kDegree},
                {"rad", 1.0},
                {"turn", 360.0 * kDegree},
                {"degrees", kDegree, false},
                {"turns", 360.0 * kDegree, false}};
    case Quantity::share:
        return {{"%", 1e-2}, {"x", 1.0, false}};
    case Quantity::seconds:
        return {{"s", 1.0}, {"ms", 1e-3}, {"min", 60.0}, {"sec", 1.0, false}};
    case Quantity::volume:
        return {{"cm" + kCubed, 1e-6, false}, {"cm3", 1e-6}, {"mm3", 1e-9}, {"mm" + kCubed, 1e-9, false}, {"m3", 1.0},
                {"m" + kCubed, 1.0, false},   {"ml", 1e-6},  {"l", 1e-3}};
    }
    return {};
}

std::optional<double> siOf(const QString& unit, Quantity quantity) {
    const auto known = units(quantity);
    if (unit.isEmpty()) return known.front().si;
    for (const Unit& candidate : known)
        if (candidate.name.compare(unit, Qt::CaseInsensitive) == 0) return candidate.si;
    return std::nullopt;
}

/// In the quantity's own unit: short where more digits would say nothing.
int decimals(double shown, Quantity quantity) {
    const double size = std::abs(shown);
    switch (quantity) {
    case Quantity::plain:
        return size >= 100.0 ? 1 : size >= 10.0 ? 2 : 3;
    case Quantity::length:
        return size >= 100.0 ? 1 : 2;
    case Quantity::angle:
        return 1;
    case Quantity::share:
        return size >= 99.95 ? 0 : 1;
    case Quantity::level:
        return 1;
    case Quantity::seconds:
        return 2;
    case Quantity::volume:
        return size >= 1000.0 ? 0 : size >= 100.0 ? 1 : 2;
    }
    return 2;
}

/// Digits after the point that are all zero say nothing for these.
bool dropsZeros(Quantity quantity) {
    return quantity == Quantity::plain || quantity == Quantity::share || quantity == Quantity::level;
}

} // namespace

std::optional<double> parseQuantity(const QString& text, Quantity quantity) {
    QString plain = text.trimmed();
    plain.replace(QChar(0x2212), '-');
    static const QRegularExpression form("^([+-]?(?:\\d+(?:[.,]\\d*)?|[.,]\\d+)(?:[eE][+-]?\\d+)?)\\s*(\\D.*)?$");
    const auto match = form.match(plain);
    if (!match.hasMatch()) return std::nullopt;
    const auto si = siOf(match.captured(2).trimmed(), quantity);
    bool isNumber = false;
    const double number = match.captured(1).replace(',', '.').toDouble(&isNumber);
    if (!si || !isNumber || !std::isfinite(number * *si)) return std::nullopt;
    return number * *si;
}

QString formatQuantity(double value, Quantity quantity) {
    const Unit own = units(quantity).front();
    const double shown = value / own.si;
    const int digits = decimals(shown, quantity);
    QString number = QLocale::c().toString(shown, 'f', digits).remove(',');
    if (dropsZeros(quantity) && number.contains('.')) {
        while (number.endsWith('0')) number.chop(1);
        if (number.endsWith('.')) number.chop(1);
    }
    if (number.toDouble() == 0.0 && number.startsWith('-')) number.remove(0, 1);
    if (own.name.isEmpty()) return number;
    return quantity == Quantity::angle ? number + own.name : number + ' ' + own.name;
}

QString unitsOf(Quantity quantity) {
    QStringList names;
    for (const Unit& unit : units(quantity))
        if (unit.told) names << unit.name;
    return names.join(", ");
}

double usualStep(Quantity quantity) {
    switch (quantity) {
    case Quantity::plain:
        return 0.01;
    case Quantity::length:
        return 1e-3;
    case Quantity::angle:
        return kDegree;
    case Quantity::share:
        return 0.01;
    case Quantity::level:
        return 1.0;
    case Quantity::seconds:
        return 0.1;
    case Quantity::volume:
        return 1e-6;
    }
    return 1.0;
}

} // namespace lumorph::studio
