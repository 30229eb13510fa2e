#include "core/rig/templates/rig_templates.h"

#include <limits>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/geometry/mesh_check.h"
#include "core/rig/rig_file.h"
#include "tests/support/long_tests.h"

namespace lumorph {
namespace {

Rig rigWith(const char* name, std::initializer_list<const char*> texts) {
    const RigTemplate& kind = rigTemplate(name);
    std::vector<TemplateChoice> choices;
    for (const char* text : texts) choices.push_back(parseChoice(kind, text));
    return rigOf(kind, choices);
}

glm::vec3 sizeOf(const Rig& rig) { return boundingBox(rig.restMesh().positions).size(); }

TEST(RigTemplates, TabletAndPinsAreTheBundledModels) {
    for (const auto& [name, file] : {std::pair("tablet", "tablet.glb"), std::pair("pins", "pin_display.glb")})
        EXPECT_EQ(writeRigGlb(rigOf(rigTemplate(name), {})),
                  readFile(std::string(LUMORPH_SOURCE_DIR "/resources/models/") + file, 1 << 24))
            << name;
}

TEST(RigTemplates, AreSoundAndOpenAgain) {
    for (const RigTemplate& kind : rigTemplates()) {
        const Rig rig = rigOf(kind, {});
        EXPECT_TRUE(rig.pathInside()) << kind.name;
        EXPECT_EQ(rig.actuatorCount() == 0, kind.name == "sheet") << kind.name;
        for (const double stroke : {0.0, 0.3, 1.0}) {
            const MeshReport report = checkMesh(deformed(rig, std::vector<double>(rig.actuatorCount(), stroke)));
            EXPECT_TRUE(report.solid()) << kind.name << ' ' << testing::PrintToString(report.findings());
            EXPECT_EQ(report.components, 1U);
        }
        EXPECT_EQ(readRigGlb(writeRigGlb(rig), "again").actuatorCount(), rig.actuatorCount()) << kind.name;
    }
}

TEST(RigTemplates, ParametersAreCentimetresOrWithAUnit) {
    EXPECT_NEAR(sizeOf(rigWith("tablet", {"top=cut", "width=30"})).x, 0.3, 1e-6);
    EXPECT_NEAR(sizeOf(rigWith("tablet", {"width=300mm", "top=cut", "depth=0.2m"})).z, 0.2, 1e-6);
    EXPECT_NEAR(sizeOf(rigWith("cushion", {"height=7cm"})).y, 0.07, 1e-6);
    EXPECT_NEAR(rigWith("tablet", {"top=cut", "reach=8cm"}).reach().max.y, 0.08, 1e-4);
    EXPECT_EQ(rigWith("flower", {"petals=4"}).actuatorCount(), 4U);
    EXPECT_EQ(rigWith("pins", {"columns=7", "rows=3"}).actuatorCount(), 21U);
    EXPECT_NEAR(rigWith("pins", {"columns=2", "rows=2", "stroke=3"}).reach().max.y, 0.08, 1e-6);
    EXPECT_NEAR(std::get<Bend>(rigWith("book", {"angle=60deg"}).actuators()[0].deformer).max.inDegrees(), 60.0, 1e-9);
}

TEST(RigTemplates, SheetsHaveTheChoiceOfAContinuousTop) {
    for (const char* name : {"phone", "flower", "book"}) {
        const RigTemplate& kind = rigTemplate(name);
        const Rig cut = rigOf(kind, {});
        const Rig whole = rigOf(kind, std::vector{parseChoice(kind, "top=continuous")}, {}, SheetQuality::preview);
        ASSERT_EQ(whole.actuatorCount(), cut.actuatorCount()) << name;
        for (std::size_t a = 0; a < cut.actuatorCount(); ++a) {
            EXPECT_EQ(whole.actuators()[a].name, cut.actuators()[a].name);
            EXPECT_TRUE(std::holds_alternative<SheetLift>(whole.actuators()[a].deformer)) << name;
        }
        EXPECT_GT(whole.reach().max.y, 1.2F * sizeOf(cut).y) << name;
        EXPECT_NEAR(sizeOf(whole).x, sizeOf(cut).x, 0.01) << name;
    }
}

TEST(RigTemplates, BookHasALeafOnEachSide) {
    const Rig book = rigWith("book", {});
    ASSERT_EQ(book.actuatorCount(), 2U);
    for (const std::uint32_t v : book.verticesOf(0)) EXPECT_LT(book.restMesh().positions[v].x, -0.0099F);
    for (const std::uint32_t v : book.verticesOf(1)) EXPECT_GT(book.restMesh().positions[v].x, 0.0099F);
    EXPECT_GT(book.reach().max.y, 0.14F);
}

TEST(RigTemplates, ErrorsNameTheParameter) {
    struct Wrong {
        const char* kind;
        const char* text;
        const char* says;
    };
    for (const Wrong& wrong : {
             Wrong{"tablet", "width", "no parameter with a value"},
             Wrong{"tablet", "width=wide", "no parameter with a value"},
             Wrong{"tablet", "width=21kg", "mm, cm or m"},
             Wrong{"tablet", "width=nan", "tablet: width: it is no finite number"},
             Wrong{"tablet", "width=inf", "tablet: width: it is no finite number"},
             Wrong{"tablet", "width=-3", "tablet: width: -3 cannot be"},
             Wrong{"tablet", "girth=3", "'girth': there is no such parameter"},
             Wrong{"cut tablet", "reach=2cm", "tablet: reach: the flaps of the long edges would vanish"},
             Wrong{"cut tablet", "reach=20cm", "would meet in the middle"},
             Wrong{"cut tablet", "cornerX=1", "the corners would vanish"},
             Wrong{"cut tablet", "cornerZ=9", "the corners of one side would meet"},
             Wrong{"cut tablet", "cornerX=10", "nothing would be left"},
             Wrong{"tablet", "top=round", "tablet: top: 'round' is none of its choices; choose cut or continuous"},
             Wrong{"tablet", "reach=8cm", "tablet: reach: a top that is not so has no such measure"},
             Wrong{"cut tablet", "thickness=0.1", "choose top=continuous"},
             Wrong{"phone", "corner=1", "phone: corner: the corners would vanish"},
             Wrong{"phone", "corner=5", "phone: corner: nothing would be left"},
             Wrong{"pins", "pin=0.5", "pins: pitch: the pins would touch"},
             Wrong{"pins", "rows=2.5", "pins: rows"},
             Wrong{"pins", "rows=0", "pins: rows"},
             Wrong{"flower", "middle=2", "flower: middle: the petals would be too narrow"},
             Wrong{"flower", "diameter=10", "flower: diameter: the petals would vanish"},
             Wrong{"book", "spine=29", "book: spine: the leaves would vanish"},
             Wrong{"cushion", "width=1", "cushion: width, depth: the chambers would vanish"},
             Wrong{"sheet", "thickness=0", "sheet: thickness: 0 cannot be"},
         }) {
        try {
            if (wrong.kind == std::string("cut tablet"))
                (void)rigWith("tablet", {"top=cut", wrong.text});
            else
                (void)rigWith(wrong.kind, {wrong.text});
            ADD_FAILURE() << wrong.kind << ' ' << wrong.text;
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find(wrong.says), std::string::npos) << error.what();
        }
    }
    EXPECT_THROW((void)rigTemplate("chair"), InvalidInput);
}

// Whatever a parameter is set to within its range, a sound rig comes of it, or an error that names the template.
TEST(RigTemplates, EveryParameterAtItsEndsIsARigOrNamed) {
    for (const RigTemplate& kind : rigTemplates()) {
        if (kind.name == "pins" && !test::longTests()) continue; // thousands of pins
        for (const TemplateParameter& parameter : kind.parameters)
            for (const double value : {parameter.min, parameter.max}) {
                const std::vector<TemplateChoice> choices{{std::string(parameter.name), value}};
                try {
                    const Rig rig = rigOf(kind, choices, {}, SheetQuality::preview);
                    EXPECT_TRUE(checkMesh(rig.restMesh()).solid())
                        << kind.name << ' ' << parameter.name << ' ' << value;
                } catch (const InvalidInput& error) {
                    EXPECT_TRUE(error.subject().starts_with(kind.name) || error.subject().starts_with("sheet") ||
                                error.subject().starts_with("bend line") || error.subject().starts_with("lever"))
                        << error.what();
                }
            }
    }
}

} // namespace
} // namespace lumorph
