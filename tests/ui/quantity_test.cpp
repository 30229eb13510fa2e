#include "app/studio/widgets/quantity.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace lumorph::studio {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Quantity, ReadsNumbersWithAndWithoutUnits) {
    struct Row {
        const char* text;
        Quantity quantity;
        double si;
    };
    const Row rows[] = {
        {"2 cm", Quantity::length, 0.02},        {"2", Quantity::length, 0.02},
        {"2cm", Quantity::length, 0.02},         {" 24 MM ", Quantity::length, 0.024},
        {"3 in", Quantity::length, 0.0762},      {"1 ft", Quantity::length, 0.3048},
        {"0,5 m", Quantity::length, 0.5},        {".5 m", Quantity::length, 0.5},
        {"-1.5e1 mm", Quantity::length, -0.015}, {"+2 cm", Quantity::length, 0.02},
        {"\u22122 cm", Quantity::length, -0.02}, {"45 deg", Quantity::angle, kPi / 4},
        {"45\u00b0", Quantity::angle, kPi / 4},  {"45", Quantity::angle, kPi / 4},
        {"0.5 rad", Quantity::angle, 0.5},       {"0,25 turn", Quantity::angle, kPi / 2},
        {"12.5 %", Quantity::share, 0.125},      {"120", Quantity::share, 1.2},
        {"1.5x", Quantity::share, 1.5},          {"250 ms", Quantity::seconds, 0.25},
        {"2 min", Quantity::seconds, 120.0},     {"3 cm3", Quantity::volume, 3e-6},
        {"3 cm\u00b3", Quantity::volume, 3e-6},  {"1 l", Quantity::volume, 1e-3},
        {"17", Quantity::level, 17.0},           {"0.75", Quantity::plain, 0.75},
    };
    for (const Row& row : rows) {
        const auto read = parseQuantity(QString::fromUtf8(row.text), row.quantity);
        ASSERT_TRUE(read.has_value()) << row.text;
        EXPECT_NEAR(*read, row.si, 1e-12 + 1e-12 * std::abs(row.si)) << row.text;
    }
}

TEST(Quantity, RefusesWhatIsNoNumberOfThatKind) {
    struct Row {
        const char* text;
        Quantity quantity;
    };
    const Row rows[] = {
        {"", Quantity::length},        {"cm", Quantity::length},        {"2 deg", Quantity::length},
        {"two cm", Quantity::length},  {"2 cm 3", Quantity::length},    {"1.2.3", Quantity::length},
        {"1,234.5", Quantity::length}, {"nan", Quantity::plain},        {"inf", Quantity::plain},
        {"1e999", Quantity::plain},    {"5 %", Quantity::angle},        {"0x10", Quantity::plain},
        {"--2", Quantity::plain},      {"1e308 turn", Quantity::angle}, {"2 cm", Quantity::plain},
    };
    for (const Row& row : rows) EXPECT_FALSE(parseQuantity(row.text, row.quantity).has_value()) << row.text;
}

TEST(Quantity, Calculates) {
    struct Row {
        const char* text;
        Quantity quantity;
        double si;
    };
    const Row rows[] = {
        {"90+45", Quantity::angle, 0.75 * kPi},
        {"2cm+5mm", Quantity::length, 0.025},
        {"2 cm + 5", Quantity::length, 0.07},
        {"5 + 2 mm", Quantity::length, 0.052},
        {"1 - 2 - 3", Quantity::level, -4.0},
        {"2+3*4", Quantity::plain, 14.0},
        {"(2+3)*4", Quantity::plain, 20.0},
        {"12/4/3", Quantity::plain, 1.0},
        {"3*2cm", Quantity::length, 0.06},
        {"2cm*3", Quantity::length, 0.06},
        {"(1 + 2) mm", Quantity::length, 0.003},
        {"1 in / 2", Quantity::length, 0.0127},
        {"10 cm / 5 mm", Quantity::length, 0.2},
        {"1 turn / 4 + 10", Quantity::angle, 100.0 * kPi / 180.0},
        {"2 - -3", Quantity::level, 5.0},
        {"-(2+1)", Quantity::level, -3.0},
        {"6 \u00d7 7 \u00f7 2", Quantity::level, 21.0},
        {"1,5 cm + 0.5 cm", Quantity::length, 0.02},
        {"2 cm3 + 1 ml", Quantity::volume, 3e-6},
        {"1e1+1", Quantity::level, 11.0},
        {"50 % * 3", Quantity::share, 1.5},
    };
    for (const Row& row : rows) {
        const auto read = readQuantity(QString::fromUtf8(row.text), row.quantity);
        ASSERT_TRUE(read.value.has_value()) << row.text << ": " << read.why.toStdString();
        EXPECT_NEAR(*read.value, row.si, 1e-12 + 1e-12 * std::abs(row.si)) << row.text;
        EXPECT_TRUE(read.why.isEmpty());
    }
}

TEST(Quantity, SaysWhyItIsNoNumber) {
    struct Row {
        QString text;
        Quantity quantity;
        const char* says;
    };
    const Row rows[] = {
        {"2 apples", Quantity::length, "cm, mm, m, in, ft"},
        {"2 cm", Quantity::plain, "not a unit here"},
        {"90+", Quantity::angle, "missing at the end"},
        {"90 45", Quantity::angle, "before \"45\""},
        {"(90+45", Quantity::angle, "not closed"},
        {"90)", Quantity::angle, "not opened"},
        {"2cm*3mm", Quantity::length, "cannot be multiplied"},
        {"2/3mm", Quantity::length, "cannot be divided"},
        {"1/0", Quantity::plain, "divided by 0"},
        {"1/(2-2)", Quantity::plain, "divided by 0"},
        {"1e300*1e300", Quantity::plain, "too large"},
        {"(2 cm) mm", Quantity::length, "has a unit already"},
        {"", Quantity::length, "Type a number, such as 2 cm"},
        {"two", Quantity::length, "not a number"},
        {QString(5000, '('), Quantity::plain, "too many brackets"},
    };
    for (const Row& row : rows) {
        const auto read = readQuantity(row.text, row.quantity);
        EXPECT_FALSE(read.value.has_value()) << row.text.left(20).toStdString();
        EXPECT_TRUE(read.why.contains(row.says)) << row.text.left(20).toStdString() << ": " << read.why.toStdString();
    }
}

TEST(Quantity, WritesAsManyDigitsAsMakeSense) {
    struct Row {
        double si;
        Quantity quantity;
        const char* text;
    };
    const Row rows[] = {
        {0.024, Quantity::length, "2.40 cm"},  {1.5, Quantity::length, "150.0 cm"},
        {-1e-9, Quantity::length, "0.00 cm"},  {kPi / 4, Quantity::angle, "45.0\u00b0"},
        {1.2, Quantity::share, "120 %"},       {0.125, Quantity::share, "12.5 %"},
        {0.5, Quantity::share, "50 %"},        {0.9996, Quantity::share, "100 %"},
        {17.0, Quantity::level, "17"},         {16.4, Quantity::level, "16.4"},
        {1.25, Quantity::seconds, "1.25 s"},   {12.3e-6, Quantity::volume, "12.30 cm\u00b3"},
        {1.234, Quantity::plain, "1.234"},     {2.5, Quantity::plain, "2.5"},
        {1000.0, Quantity::share, "100000 %"},
    };
    for (const Row& row : rows) EXPECT_EQ(formatQuantity(row.si, row.quantity).toStdString(), row.text) << row.si;
}

TEST(Quantity, ReadsWhatItWrites) {
    for (const Quantity quantity : {Quantity::plain, Quantity::length, Quantity::angle, Quantity::share,
                                    Quantity::level, Quantity::seconds, Quantity::volume})
        for (const double value : {0.0, 1.0, -0.37, 12.0, 1e-4}) {
            const QString text = formatQuantity(value, quantity);
            const auto read = parseQuantity(text, quantity);
            ASSERT_TRUE(read.has_value()) << text.toStdString();
            EXPECT_EQ(formatQuantity(*read, quantity), text);
        }
}

} // namespace
} // namespace lumorph::studio
