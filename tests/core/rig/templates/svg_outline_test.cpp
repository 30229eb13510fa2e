#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/rig/templates/sheet_outline.h"

namespace lumorph {
namespace {

double area(const std::vector<glm::dvec2>& p) {
    double sum = 0.0;
    for (std::size_t k = 0; k < p.size(); ++k) {
        const glm::dvec2& b = p[(k + 1) % p.size()];
        sum += 0.5 * (p[k].x * b.y - p[k].y * b.x);
    }
    return std::abs(sum);
}

std::string page(const std::string& shapes) {
    return R"(<?xml version="1.0"?><!DOCTYPE svg><!-- <rect/> --><svg xmlns="http://www.w3.org/2000/svg" )"
           R"(width="200mm" height="100mm" viewBox="0 0 200 100">)" +
           shapes + "</svg>";
}

struct Shape {
    const char* svg;
    double squareMillimetres;
};

class SvgOutline : public testing::TestWithParam<Shape> {};

TEST_P(SvgOutline, EnclosesTheAreaOfTheShape) {
    EXPECT_NEAR(1e6 * area(svgOutline(page(GetParam().svg), "a.svg")), GetParam().squareMillimetres,
                0.005 * GetParam().squareMillimetres);
}

constexpr double kPi = std::numbers::pi;

INSTANTIATE_TEST_SUITE_P(
    Shapes, SvgOutline,
    testing::Values(
        Shape{"<rect x='10' y='20' width='60' height='40'/>", 2400.0},
        Shape{"<rect width='60' height='40' rx='10'/>", 2400.0 - (4.0 - kPi) * 100.0},
        Shape{"<rect width='60' height='40' rx='10' ry='5'/>", 2400.0 - (4.0 - kPi) * 50.0},
        Shape{"<rect width='6cm' height='40'/>", 6.0 * 96.0 / 2.54 * 40.0}, // a cm is 96/2.54 units of the drawing
        Shape{"<circle cx='50' cy='50' r='30'/>", kPi * 900.0},
        Shape{"<ellipse cx='50' cy='50' rx='40' ry='20'/>", kPi * 800.0},
        Shape{"<polygon points='0,0 40,0 40 30'/>", 600.0}, Shape{"<polyline points='0 0 40 0 40 30 0 0'/>", 600.0},
        Shape{"<path d='M10 10h40v30H10z'/>", 1200.0},
        Shape{"<path d='m10,10 40,0 0,30 -40,0'/>", 1200.0},                       // closed as where it is filled
        Shape{"<path d='M0 0L40 0L40 30Z M5 5L6 6'/>", 600.0},                     // a stray line is no part
        Shape{"<path d='M0-0L4e1-.0 40.0.0V30'/>", 600.0},                         // numbers need no spaces between
        Shape{"<path d='M20 50a30 30 0 1 0 60 0 30 30 0 10-60 0'/>", kPi * 900.0}, // flags neither
        Shape{"<path d='M20 50A30 10 90 0 1 40 50L30 50Z'/>", kPi * 300.0 / 2.0},  // an upright half ellipse
        Shape{"<path d='M0 0Q30 60 60 0Z'/>", 2.0 / 3.0 * 60.0 * 30.0},            // two thirds of its box
        Shape{"<path d='M0 0Q15 30 30 0T60 0L60 40L0 40Z'/>", 2400.0},             // equal halves up and down
        Shape{"<path d='M0 0C0 40 60 40 60 0Z'/>", 0.6 * 60.0 * 40.0},
        Shape{"<path d='M0 20C10 40 20 40 30 20S50 0 60 20L60 60L0 60Z'/>", 2400.0},
        Shape{"<g transform='translate(20 10) scale(.5)'><rect width='60' height='40'/></g>", 600.0},
        Shape{"<g transform='rotate(30, 50, 50)'><g transform='skewX(20)'><rect width='60' height='40'/></g></g>",
              2400.0},
        Shape{"<rect transform='matrix(2 0 0 1 5 5)' width='30' height='40'/>", 2400.0},
        Shape{"<defs><rect width='9' height='9'/></defs><line x1='0' y1='0' x2='9' y2='9'/><text>A</text>"
              "<rect display='none' width='9' height='9'/><rect width='60' height='40'/>",
              2400.0}));

TEST(SvgOutlinePlace, IsOnThePageInMetres) {
    const auto outline = svgOutline(page("<rect x='10' y='20' width='60' height='40'/>"), "a.svg");
    EXPECT_NEAR(outline[0].x, 0.01, 1e-12);
    EXPECT_NEAR(outline[0].y, 0.02, 1e-12);
    // Without a size an inch has 96 units.
    const auto plain = svgOutline("<svg><rect x='96' width='96' height='96'/></svg>", "b.svg");
    EXPECT_NEAR(plain[0].x, 0.0254, 1e-12);
    // The view box is moved and scaled into the size.
    const auto boxed =
        svgOutline("<svg width='10cm' viewBox='-5 -5 10 10'><rect x='-5' y='0' width='5' height='5'/></svg>", "c.svg");
    EXPECT_NEAR(boxed[0].x, 0.0, 1e-12);
    EXPECT_NEAR(boxed[0].y, 0.05, 1e-12);
}

TEST(SvgOutlinePlace, IsTheSameInUtf16) {
    const std::string plain = page("<rect x='10' y='20' width='60' height='40'/>");
    for (const bool big : {false, true}) {
        std::string wide = big ? "\xFE\xFF" : "\xFF\xFE";
        for (const char c : plain) {
            if (big) wide += '\0';
            wide += c;
            if (!big) wide += '\0';
        }
        EXPECT_EQ(svgOutline(wide, "wide.svg"), svgOutline(plain, "plain.svg"));
    }
}

// Inputs of ../shared/data/cases, whose right values stand in FACTS.md there.
TEST(SvgOutlinePlace, TheCasesAreARectangleInMillimetres) {
    const std::filesystem::path folder = std::filesystem::path(LUMORPH_SHARED_DIR) / "data/cases/svg";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "without ../shared/data/cases";
    for (const char* name : {"mm-viewbox.svg", "utf16.svg"}) {
        const std::vector<std::byte> bytes = readFile(folder / name, 10'000);
        const auto outline = svgOutline({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name);
        EXPECT_NEAR(1e6 * area(outline), 160.0 * 100.0, 1e-6) << name;
        EXPECT_NEAR(outline[0].x, 0.020, 1e-12) << name;
        EXPECT_NEAR(outline[0].y, 0.020, 1e-12) << name;
    }
}

TEST(SvgOutlineErrors, NameTheDrawingAndWhatIsWrong) {
    const auto refused = [](const std::string& svg, const std::string& why) {
        try {
            (void)svgOutline(svg, "drawing.svg");
            ADD_FAILURE() << "read: " << svg;
        } catch (const DataError& error) {
            EXPECT_EQ(error.subject(), "drawing.svg");
            EXPECT_NE(error.why().find(why), std::string::npos) << error.what();
            EXPECT_FALSE(error.remedy().empty());
        }
    };
    refused("", "no SVG drawing");
    refused("%PDF-1.4", "no SVG drawing");
    refused("<html></html>", "no SVG drawing");
    refused(page(""), "holds no outline");
    refused(page("<line x1='0' y1='0' x2='50' y2='50'/><text>sheet</text>"), "holds no outline");
    refused(page("<path d='M0 0L50 50'/>"), "holds no outline");
    refused(page("<rect width='30' height='30'/><circle r='30'/>"), "holds 2 closed shapes");
    refused(page("<path d='M0 0H90V90H0Z M30 30H60V60H30Z'/>"), "2 parts or holes");
    refused(page("<path d='M0 0 L10 nan 20 20'/>"), "not understood");
    refused(page("<path d='M0 0 L10'/>"), "not understood");
    refused(page("<path d='M0 0 X10 10'/>"), "not understood");
    refused(page("<path d='M0 0 A10 10 0 2 0 5 5'/>"), "not understood");
    refused(page("<rect width='1e999' height='30'/>"), "no length");
    refused(page("<rect width='30 furlongs' height='30'/>"), "no length");
    refused(page("<g transform='wobble(3)'/>"), "not understood");
    refused(page("<g>"), "closes nothing");
    refused("<svg><rect width='30' height='30'/>", "ends within <svg>");
    refused("<svg><rect width='30", "ends before");
    refused("<!DOCTYPE svg [<!ENTITY a 'b'>]><svg/>", "entities");
    std::string deep = "<svg>";
    for (int k = 0; k < 100'000; ++k) deep += "<g>";
    refused(deep, "deeper");
}

TEST(SheetOutline, RoundShapesAreExact) {
    EXPECT_NEAR(area(ellipseOutline(0.2, 0.1)), kPi * 0.1 * 0.05, 3e-5);
    EXPECT_NEAR(area(rectangleOutline(0.2, 0.1, 0.02)), 0.02 - (4.0 - kPi) * 4e-4, 1e-5);
    EXPECT_EQ(rectangleOutline(0.2, 0.1).size(), 4U);
}

} // namespace
} // namespace lumorph
