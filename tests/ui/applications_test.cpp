#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <QAbstractButton>
#include <QLabel>
#include <QLineEdit>

#include "app/applications/registry/demos.h"
#include "app/studio/base/operator_pin.h"
#include "app/studio/shell/application_turn.h"
#include "app/studio/shell/applications_page.h"
#include "app/studio/shell/visitor_desk.h"
#include "app/studio/shell/visitor_layer.h"
#include "app/workspaces/scene/view_pane.h"
#include "tests/ui/studio_window.h"

// Applications in the real window, from their cards to the next one when nobody comes: as a host and his visitors find
// them.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using studio::ViewPane;
using studio::VisitorLayer;

/// A program that ends by an error when the test says so.
class Breakable final : public ShowProgram {
public:
    explicit Breakable(const std::atomic<bool>& breaks) : breaks_(breaks) {}
    ShowContent frame(const ShowMoment& /*moment*/) override {
        if (breaks_) throw std::runtime_error("it broke");
        return {};
    }

private:
    const std::atomic<bool>& breaks_;
};

/// While it lives, nothing that is bundled is found.
class ResourcesElsewhere {
public:
    explicit ResourcesElsewhere(const std::filesystem::path& folder) : before_(qgetenv("LUMORPH_RESOURCES")) {
        qputenv("LUMORPH_RESOURCES", QByteArray::fromStdString(folder.string()));
    }
    ~ResourcesElsewhere() {
        if (before_.isNull())
            qunsetenv("LUMORPH_RESOURCES");
        else
            qputenv("LUMORPH_RESOURCES", before_);
    }
    ResourcesElsewhere(const ResourcesElsewhere&) = delete;
    ResourcesElsewhere& operator=(const ResourcesElsewhere&) = delete;

private:
    QByteArray before_;
};

class ApplicationsWindow : public ::testing::Test {
protected:
    ApplicationsWindow() {
        studio::OperatorPin::forget(studio().settings);
        studio().settings.setLanguage(Language::english);
    }
    ~ApplicationsWindow() override {
        studio::OperatorPin::forget(studio().settings);
        studio().settings.setNextMinutes(true, 2.0);
    }

    studio::Studio& studio() { return window.studio(); }
    [[nodiscard]] bool shows(const std::string& name) {
        const Demo* demo = studio().project.demo();
        const auto& frame = studio().loop.frame();
        return demo != nullptr && demo->name == name && studio().jobs.running().empty() && frame && frame->program &&
               frame->program == studio().loop.program();
    }
    [[nodiscard]] VisitorLayer& layer() { return *window.window().findChild<VisitorLayer*>("visitors.layer"); }
    [[nodiscard]] ViewPane& eye() { return *window.find<ViewPane>("scene.eye"); }
    void moveOver(double x, double y) {
        ViewPane& pane = eye();
        QTest::mouseMove(&pane, QPoint(static_cast<int>(x * pane.width()), static_cast<int>(y * pane.height())));
    }
    void enterKiosk() {
        studio().commands.find("view.kiosk")->trigger();
        for (int twice = 0; twice < 2; ++twice) {
            for (const char* digit : {"2", "7", "1", "8"}) window.click(QString("pin.digit.") + digit);
            window.click("pin.accept");
        }
        ASSERT_TRUE(eventually([&] { return window.window().isFullScreen(); }));
    }
    void picture(const QString& name) {
        (void)eventually([&] { return !eye().picture().isNull(); }, 60s);
        window.screenshot(name, 1500ms);
    }

    TemporaryFolder folder;
    StudioWindow window{folder.path(), "scene"};
};

TEST_F(ApplicationsWindow, StartByOneClickOnACardAndExplainThemselves) {
    auto* outliner = window.find<QWidget>("dock.scene.outliner");
    window.click("bar.applications");
    auto* page = window.find<studio::ApplicationsPage>("applications");
    ASSERT_NE(page, nullptr);
    for (const Demo& demo : demos()) {
        auto* card = window.find<QAbstractButton>(QString::fromStdString("applications." + demo.name));
        ASSERT_NE(card, nullptr) << demo.name;
        EXPECT_EQ(card->text().toStdString(), demo.title.english);
        EXPECT_GE(card->width(), 260);
    }
    window.screenshot("applications", 200ms);
    window.click("applications.language");
    EXPECT_EQ(window.find<QAbstractButton>("applications.labyrinth")->text().toStdString(),
              demoNamed("labyrinth").title.german);
    window.screenshot("applications-german");
    window.click("applications.labyrinth");

    ASSERT_TRUE(eventually([&] { return shows("labyrinth"); }));
    EXPECT_TRUE(eventually([&] { return window.window().isFullScreen(); }));
    EXPECT_EQ(window.findNow<QWidget>("applications"), nullptr);
    EXPECT_FALSE(outliner->isVisible());
    EXPECT_GT(eye().width(), window.window().width() - 10) << "the view fills the window";
    EXPECT_TRUE(layer().waysShown()) << "how it is played appears by itself";
    EXPECT_TRUE(layer().handShown()) << "and that it may be touched";
    EXPECT_TRUE(eventually([&] { return layer().captionTitle() == "1  Erstes Rollen"; }));
    picture("labyrinth-attract");

    moveOver(0.5, 0.5);
    moveOver(0.7, 0.6);
    EXPECT_TRUE(eventually([&] { return !layer().handShown(); })) << "somebody plays";
    picture("labyrinth-played");
    QTest::keyClick(&eye(), Qt::Key_H);
    EXPECT_TRUE(layer().helpShown());
    picture("labyrinth-help");
    QTest::keyClick(&eye(), Qt::Key_Escape);
    EXPECT_TRUE(eventually([&] { return !layer().helpShown(); }));
    EXPECT_EQ(window.findNow<QWidget>("applications"), nullptr) << "Esc took the help away";
    QTest::keyClick(&eye(), Qt::Key_A);
    EXPECT_TRUE(eventually([&] { return layer().handShown(); })) << "left to itself";

    pass(700ms); // no second of Esc Esc
    QTest::keyClick(&eye(), Qt::Key_Escape);
    ASSERT_NE(window.find<QWidget>("applications"), nullptr) << "Esc leads back to the cards";
    EXPECT_FALSE(studio().loop.stopped());
    window.click("applications.techniques");
    ASSERT_TRUE(eventually([&] { return shows("techniques"); }));
    QTest::keyClick(&eye(), Qt::Key_4);
    EXPECT_TRUE(eventually([&] { return layer().captionTitle() == "4  Kanten"; }));
    EXPECT_FALSE(layer().captionSentence().isEmpty());
    picture("techniques-edges");
    window.click("visitors.off");
    EXPECT_TRUE(eventually([&] { return layer().captionTitle() == "4  Kanten: aus"; }));
    picture("techniques-edges-off");
    window.click("visitors.language");
    EXPECT_TRUE(eventually([&] { return layer().captionTitle() == "4  Edges: off"; }));

    window.click("bar.leaveKiosk");
    EXPECT_TRUE(eventually([&] { return !window.window().isFullScreen() && outliner->isVisible(); }));
    EXPECT_FALSE(layer().isVisible());
    EXPECT_NE(studio().loop.program(), nullptr) << "it goes on";
    QTest::keyClick(&window.window(), Qt::Key_3);
    EXPECT_TRUE(eventually([&] { return studio().loop.program() == nullptr; })) << "the host takes over";
}

/// Share of the pixels in which two pictures differ visibly.
double differing(const QImage& a, const QImage& b) {
    if (a.size() != b.size()) return 1.0;
    int count = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) count += std::abs(qGray(a.pixel(x, y)) - qGray(b.pixel(x, y))) > 24 ? 1 : 0;
    return static_cast<double>(count) / (a.width() * a.height());
}

TEST_F(ApplicationsWindow, AKeyTakesTheLightAwayAndTheBareDeviceIsSeenBesideIt) {
    studio().settings.setBareInlay({});
    window.command("Applications");
    window.click("applications.labyrinth");
    ASSERT_TRUE(eventually([&] { return shows("labyrinth"); }));
    auto* inlay = window.find<ViewPane>("scene.inlay");
    ASSERT_NE(inlay, nullptr);
    EXPECT_TRUE(eventually([&] { return !inlay->picture().isNull(); }));
    EXPECT_NEAR(inlay->width(), 0.26 * eye().width(), 2.0);
    EXPECT_GT(inlay->x(), eye().width() / 2);
    picture("labyrinth-inlay");
    const QImage felt = inlay->grab().toImage();
    QTest::keyClick(&eye(), Qt::Key_N);
    QTest::keyClick(&eye(), Qt::Key_N);
    EXPECT_TRUE(eventually([&] { return differing(felt, inlay->grab().toImage()) > 0.01; }))
        << "one sees that it takes the third level's shape";

    const QImage lit = eye().grab().toImage();
    QTest::keyClick(&eye(), Qt::Key_L);
    ASSERT_TRUE(eventually([&] { return eye().light() == 0.0; }, 10s));
    EXPECT_TRUE(eventually([&] { return differing(lit, eye().grab().toImage()) > 0.2; }));
    picture("labyrinth-bare");
    QTest::keyClick(&eye(), Qt::Key_L);
    ASSERT_TRUE(eventually([&] { return eye().light() == 1.0; }, 10s));

    QTest::keyClick(&eye(), Qt::Key_B);
    EXPECT_FALSE(inlay->isVisible());
    QTest::keyClick(&eye(), Qt::Key_B);
    EXPECT_TRUE(inlay->isVisible());
    studio().settings.setBareInlay({studio::BareInlay::Corner::bottomLeft, 0.35});
    EXPECT_NEAR(inlay->width(), 0.35 * eye().width(), 2.0);
    EXPECT_GT(inlay->y(), eye().height() / 2);
    studio().settings.setBareInlay({studio::BareInlay::Corner::none, 0.35});
    EXPECT_FALSE(inlay->isVisible());
    studio().settings.setBareInlay({});
    window.click("bar.leaveKiosk");
    EXPECT_TRUE(eventually([&] { return !inlay->isVisible(); })) << "it is the visitors'";
}

TEST_F(ApplicationsWindow, EscEscStopsWhereItAlsoLeadsToTheCards) {
    window.command("Applications");
    window.click("applications.labyrinth");
    ASSERT_TRUE(eventually([&] { return shows("labyrinth"); }));
    QTest::keyClick(&eye(), Qt::Key_Escape);
    QTest::keyClick(&eye(), Qt::Key_Escape);
    EXPECT_TRUE(eventually([&] { return studio().loop.stopped(); }));
    EXPECT_EQ(window.findNow<QWidget>("applications"), nullptr);
}

TEST_F(ApplicationsWindow, InTheKioskVisitorsChooseAndPlayAndTheNextComesWhenTheyHaveGone) {
    studio().settings.setNextMinutes(true, 0.0);
    studio().project.openDemo("labyrinth");
    ASSERT_TRUE(eventually([&] { return shows("labyrinth"); }));
    enterKiosk();
    EXPECT_TRUE(layer().handShown());
    QTest::mouseClick(&eye(), Qt::LeftButton, {}, QPoint(eye().width() - 40, eye().height() / 2));
    EXPECT_TRUE(eventually([&] { return !layer().handShown(); })) << "a press plays, too";
    pass(300ms); // whoever comes begins anew, whatever he presses
    QTest::keyClick(&eye(), Qt::Key_N);
    EXPECT_TRUE(eventually([&] { return layer().captionTitle() == "2  Mind the holes"; }, 10s));
    QTest::keyClick(&window.window(), Qt::Key_F1);
    EXPECT_TRUE(layer().helpShown());
    EXPECT_EQ(window.findNow<QWidget>("guide"), nullptr);
    picture("kiosk-help");
    window.click("visitors.help");
    EXPECT_FALSE(layer().helpShown());

    window.click("visitors.cards");
    ASSERT_NE(window.find<QWidget>("applications"), nullptr);
    EXPECT_EQ(window.findNow<QWidget>("applications.tour"), nullptr) << "that is the host's";
    window.screenshot("kiosk-applications");
    window.click("applications.techniques");
    ASSERT_TRUE(eventually([&] { return shows("techniques"); }));
    EXPECT_TRUE(window.window().isFullScreen());
    picture("kiosk-techniques");

    moveOver(0.6, 0.5);
    moveOver(0.8, 0.5);
    ASSERT_TRUE(eventually([&] { return !layer().handShown(); }));
    studio().settings.setNextMinutes(true, 0.04); // 2.4 s
    pass(3500ms);
    EXPECT_TRUE(shows("techniques")) << "somebody plays";
    QTest::keyClick(&eye(), Qt::Key_A);
    const SteadyClock clock;
    const std::string next = studio::ApplicationTurn(demos(), {}, clock).after("techniques")->name;
    EXPECT_TRUE(eventually([&] { return shows(next); })) << "nobody came";
}

TEST_F(ApplicationsWindow, WhoseMapHasGoneAreLeftOutOfTheKiosksTurnUntilItIsBack) {
    studio().settings.setNextMinutes(true, 0.0);
    const std::filesystem::path map = folder / "valley.geojson", missing = folder / "missing.geojson";
    studio().settings.setToldTo("navigation", {{"map", missing.string()}});
    studio().project.openDemo("labyrinth");
    ASSERT_TRUE(eventually([&] { return shows("labyrinth"); }));
    enterKiosk();
    studio().settings.setNextMinutes(true, 0.005); // 0.3 s
    EXPECT_TRUE(eventually([&] { return shows("ambient"); }, 60s)) << "past navigation";
    studio().settings.setNextMinutes(true, 0.0);
    const auto notices = studio().notices.at("visitors");
    ASSERT_EQ(notices.size(), 1U);
    EXPECT_EQ(notices.front().subject.toStdString(), demoNamed("navigation").title.english);
    EXPECT_TRUE(notices.front().why.contains("missing.geojson")) << notices.front().why.toStdString();
    EXPECT_TRUE(notices.front().remedy.contains("10 minutes")) << notices.front().remedy.toStdString();
    EXPECT_EQ(window.findNow<QWidget>("visitors.rest"), nullptr);

    window.click("visitors.cards");
    (void)window.find<QAbstractButton>("applications.labyrinth");
    EXPECT_EQ(window.findNow<QWidget>("applications.navigation"), nullptr) << "nobody is led there in vain";
    window.screenshot("kiosk-left-out");
    window.click("applications.back");

    std::ofstream(missing) << R"({"type":"FeatureCollection","features":[{"type":"Feature",)"
                           << R"("properties":{"height":12},"geometry":{"type":"Polygon","coordinates":)"
                           << R"([[[9.0,0.0],[9.001,0.0],[9.001,0.001],[9.0,0.001],[9.0,0.0]]]}}]})";
    window.click("visitors.cards");
    window.click("applications.navigation");
    EXPECT_TRUE(eventually([&] { return shows("navigation"); }, 60s)) << "its file is back";
    EXPECT_TRUE(studio().notices.at("visitors").empty());
    studio().settings.setToldTo("navigation", {});
}

TEST_F(ApplicationsWindow, OfWhichNoneCanBeShownLeaveAQuietPageInTheKiosk) {
    studio().settings.setNextMinutes(true, 0.0);
    std::atomic<bool> breaks = false;
    studio().project.openDemo("labyrinth", [&breaks](std::uint64_t) -> std::unique_ptr<ShowProgram> {
        return std::make_unique<Breakable>(breaks);
    });
    ASSERT_TRUE(eventually([&] { return studio().loop.program() != nullptr; }));
    // All others have something to open that is not there.
    int opened = 0, failures = 0;
    QObject::connect(&studio().project, &studio::ProjectService::programOpened, &window.window(), [&] { ++opened; });
    QObject::connect(&studio().project, &studio::ProjectService::demoFailed, &window.window(), [&] { ++failures; });
    const ResourcesElsewhere nowhere(folder / "nowhere");
    enterKiosk();
    EXPECT_EQ(window.findNow<QWidget>("visitors.rest"), nullptr);
    breaks = true;
    ASSERT_NE(window.find<QWidget>("visitors.rest"), nullptr);
    window.screenshot("kiosk-rest");
    const int tried = failures;
    EXPECT_GE(tried, 3);
    pass(5s);
    EXPECT_EQ(failures, tried) << "none is tried again and again";
    EXPECT_EQ(opened, 0);
    EXPECT_NE(window.findNow<QWidget>("visitors.rest"), nullptr);
}

TEST_F(ApplicationsWindow, CompareTheBendInTwoHalvesInTheVisitorsLanguage) {
    window.command("Applications");
    window.click("applications.navigation");
    EXPECT_TRUE(eventually([&] { return layer().openingShown() && layer().isVisible(); }))
        << "a map takes its time, and what showed before is veiled";
    window.screenshot("navigation-opening", 0ms);
    ASSERT_TRUE(eventually([&] { return shows("navigation"); }, 60s));
    EXPECT_FALSE(layer().openingShown());
    QTest::keyClick(&eye(), Qt::Key_O);
    auto* without = window.find<ViewPane>("scene.cropped");
    auto* with = window.find<ViewPane>("scene.uncropped");
    ASSERT_TRUE(without != nullptr && with != nullptr);
    EXPECT_EQ(without->label(), "Without bending");
    window.click("visitors.language");
    EXPECT_EQ(without->label(), "Ohne Biegen");
    EXPECT_EQ(with->label(), QString::fromStdString(bendCaptions()[1].german));
    EXPECT_TRUE(eventually([&] { return !without->picture().isNull() && !with->picture().isNull(); }, 60s));
    window.screenshot("navigation-bend", 1500ms);
    EXPECT_TRUE(eventually([&] { return without->picture() != with->picture(); }));
    QTest::keyClick(with, Qt::Key_O);
    EXPECT_TRUE(eventually([&] { return eye().isVisible() && !with->isVisible(); }));
}

TEST_F(ApplicationsWindow, AreToldByTheHostWhatToShow) {
    studio().settings.setToldTo("ambient", {});
    window.click("bar.applications");
    EXPECT_EQ(window.findNow<QWidget>("applications.labyrinth.options"), nullptr) << "it has nothing to be told";
    window.click("applications.ambient.options");
    window.enter("options.place", "north of here", Qt::Key_Tab);
    window.screenshot("application-options");
    window.click("options.start");
    ASSERT_TRUE(eventually([&] { return !studio().notices.at("project").empty(); }));
    EXPECT_TRUE(studio().notices.at("project").front().subject.contains("north of here"));
    EXPECT_TRUE(eventually([&] { return !window.window().isFullScreen(); })) << "where it can be read";
    EXPECT_TRUE(eventually([&] { return window.find<QWidget>("notices.project")->findChild<QLabel*>() != nullptr; }));
    picture("application-options-wrong");

    window.click("bar.applications");
    window.click("applications.ambient.options");
    EXPECT_EQ(window.find<QLineEdit>("options.place")->text(), "north of here") << "as it was said";
    window.click("options.usual");
    EXPECT_TRUE(window.find<QLineEdit>("options.place")->text().isEmpty());
    window.enter("options.place", "-33.9,18.4,2", Qt::Key_Tab);
    window.click("options.start");
    ASSERT_TRUE(eventually([&] { return shows("ambient"); }));
    EXPECT_EQ(studio().settings.toldTo("ambient"), (DemoTold{{"place", "-33.9,18.4,2"}}));
    picture("ambient-told");
    studio().settings.setToldTo("ambient", {});
}

} // namespace
} // namespace lumorph::test
