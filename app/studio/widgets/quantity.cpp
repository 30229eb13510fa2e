#include "app/studio/widgets/quantity.h"

#include <cmath>
#include <numbers>
#include <utility>
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

struct NotANumber {
    QString why;
};

/// One pass over what was typed, by the usual grammar: a sum of products of numbers, signs and brackets.
class Calculation {
public:
    Calculation(QString text, Quantity quantity) : text_(std::move(text)), quantity_(quantity) {
        text_.replace(QChar(0x2212), '-').replace(QChar(0x00D7), '*').replace(QChar(0x00F7), '/');
    }

    double result() {
        if (atEnd()) throw NotANumber{"Type a number" + example()};
        const Part whole = sum();
        if (!atEnd() && text_[at_] == ')') throw NotANumber{"A bracket is closed that was not opened."};
        if (!atEnd()) throw NotANumber{QString("There is no +, -, * or / before \"%1\".").arg(text_.mid(at_))};
        return inUnit(whole);
    }

private:
    /// Without a unit it may be a factor, or stand for the quantity's own unit.
    struct Part {
        double number = 0.0;
        bool hasUnit = false;
    };
    static constexpr int kDeepest = 40; // brackets in brackets

    [[nodiscard]] bool atEnd() {
        while (at_ < text_.size() && text_[at_].isSpace()) ++at_;
        return at_ == text_.size();
    }
    [[nodiscard]] bool take(char sign) {
        if (atEnd() || text_[at_] != QLatin1Char(sign)) return false;
        ++at_;
        return true;
    }
    [[nodiscard]] QString example() const {
        const QString own = units(quantity_).front().name;
        return own.isEmpty() ? QString(", such as 2 or 1+0.5.") : QString(", such as 2 %1 or 1+0.5.").arg(own);
    }
    [[nodiscard]] double inUnit(const Part& part) const {
        return finite(part.hasUnit ? part.number : part.number * units(quantity_).front().si);
    }
    [[nodiscard]] static double finite(double number) {
        if (!std::isfinite(number)) throw NotANumber{"This number is too large."};
        return number;
    }

    Part sum() {
        Part left = product();
        for (;;) {
            const bool plus = take('+');
            if (!plus && !take('-')) return left;
            const Part right = product();
            const bool bare = !left.hasUnit && !right.hasUnit;
            const double a = bare ? left.number : inUnit(left), b = bare ? right.number : inUnit(right);
            left = {finite(plus ? a + b : a - b), !bare};
        }
    }

    Part product() {
        Part left = factor();
        for (;;) {
            const bool times = take('*');
            if (!times && !take('/')) return left;
            const Part right = factor();
            if (times && left.hasUnit && right.hasUnit)
                throw NotANumber{"Two numbers with units cannot be multiplied; leave one unit out."};
            if (!times && right.hasUnit && !left.hasUnit)
                throw NotANumber{"A number without a unit cannot be divided by one with a unit."};
            if (!times && right.number == 0.0) throw NotANumber{"Nothing can be divided by 0."};
            const bool unit = times ? left.hasUnit || right.hasUnit : left.hasUnit && !right.hasUnit;
            left = {finite(times ? left.number * right.number : left.number / right.number), unit};
        }
    }

    /// One sign at most: two are a slip of the finger.
    Part factor() {
        const bool minus = take('-');
        if (!minus && take('+')) return primary();
        const Part part = primary();
        return minus ? Part{-part.number, part.hasUnit} : part;
    }

    Part primary() {
        Part part;
        if (take('(')) {
            if (++depth_ > kDeepest) throw NotANumber{"There are too many brackets."};
            part = sum();
            --depth_;
            if (!take(')')) throw NotANumber{"A bracket is not closed."};
        } else {
            part.number = number();
        }
        return withUnit(part);
    }

    double number() {
        static const QRegularExpression form("(?:\\d+(?:[.,]\\d*)?|[.,]\\d+)(?:[eE][+-]?\\d+)?");
        if (atEnd()) throw NotANumber{QString("A number is missing at the end of \"%1\".").arg(text_.trimmed())};
        const auto match =
            form.match(text_, at_, QRegularExpression::NormalMatch, QRegularExpression::AnchorAtOffsetMatchOption);
        if (!match.hasMatch()) throw NotANumber{QString("\"%1\" is not a number").arg(text_.mid(at_)) + example()};
        at_ += match.capturedLength();
        return finite(match.captured().replace(',', '.').toDouble());
    }

    Part withUnit(const Part& part) {
        // Volumes end in a digit: "cm3".
        static const QRegularExpression form("[^\\d\\s+\\-*/().,]+3?");
        if (atEnd()) return part;
        const auto match =
            form.match(text_, at_, QRegularExpression::NormalMatch, QRegularExpression::AnchorAtOffsetMatchOption);
        if (!match.hasMatch()) return part;
        const auto si = siOf(match.captured(), quantity_);
        const QString known = unitsOf(quantity_);
        if (!si)
            throw NotANumber{QString("\"%1\" is not a unit here; ").arg(match.captured()) +
                             (known.isEmpty() ? QString("it has none.") : QString("there are %1.").arg(known))};
        if (part.hasUnit) throw NotANumber{QString("What is in brackets has a unit already.")};
        at_ += match.capturedLength();
        return {finite(part.number * *si), true};
    }

    QString text_;
    Quantity quantity_;
    qsizetype at_ = 0;
    int depth_ = 0;
};

} // namespace

TypedQuantity readQuantity(const QString& text, Quantity quantity) {
    try {
        return {Calculation(text, quantity).result(), {}};
    } catch (const NotANumber& error) {
        return {std::nullopt, error.why};
    }
}

std::optional<double> parseQuantity(const QString& text, Quantity quantity) {
    return readQuantity(text, quantity).value;
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
