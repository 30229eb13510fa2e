#include <atomic>
#include <fstream>
#include <sstream>

#include "app/applications/labyrinth/board.h"
#include "app/applications/labyrinth/ghost.h"
#include "tests/ui/studio_window.h"

// What applications want kept, in the studio: written beside the loop, read at the next start, and never lost.

namespace lumorph::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

std::string textOf(const fs::path& file) {
    std::ifstream stream(file);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
}

/// Wants another thing kept in each of its first frames.
class Keeping : public ShowProgram {
public:
    static constexpr int kTimes = 20;
    ShowContent frame(const ShowMoment& /*moment*/) override {
        ShowContent content;
        if (asked_ < kTimes) content.keepsake = [number = ++asked_] { return std::to_string(number); };
        return content;
    }

private:
    int asked_ = 0;
};

TEST(KeepsakeKeeper, TheNewestIsInTheFileAndThatOfAnotherProgramIsNot) {
    const TemporaryFolder folder;
    StudioWindow window{folder / "session", "scene"};
    const fs::path file = folder / "kept/own.json";
    const auto kept = std::make_shared<Keeping>();
    window.studio().keepsakes.keep(kept, file);
    window.studio().loop.setProgram(kept);
    EXPECT_TRUE(eventually([&] { return textOf(file) == std::to_string(Keeping::kTimes); })) << textOf(file);
    window.studio().loop.setProgram(std::make_shared<Keeping>()); // nobody said where to
    pass(500ms);
    fs::remove(file);
    pass(300ms);
    EXPECT_FALSE(fs::exists(file));
    window.studio().loop.setProgram(nullptr);
}

TEST(KeepsakeKeeper, WhatCannotBeWrittenIsTold) {
    const TemporaryFolder folder;
    StudioWindow window{folder / "session", "scene"};
    std::ofstream(folder / "taken") << "a file where a folder should be";
    const auto kept = std::make_shared<Keeping>();
    window.studio().keepsakes.keep(kept, folder / "taken/own.json");
    window.studio().loop.setProgram(kept);
    EXPECT_TRUE(eventually([&] {
        for (const studio::Notice& notice : window.studio().notices.at("project"))
            if (notice.subject.contains("own.json")) return true;
        return false;
    }));
    window.studio().loop.setProgram(nullptr);
}

TEST(KeepsakeKeeper, TheGhostOfTheLastTimeIsThereAndADamagedFileIsSetAside) {
    const TemporaryFolder folder;
    const fs::path file = folder / "session/applications/labyrinth.json";
    labyrinth::Ghost best{labyrinth::bundledLevels().front().name, 9.0, 700, {}};
    for (int k = 0; k < 270; ++k) best.positions.emplace_back(0.0003F * static_cast<float>(k) - 0.04F, 0.003F, 0.01F);
    {
        StudioWindow window{folder / "session", "scene"};
        fs::create_directories(file.parent_path());
        std::ofstream(file) << labyrinth::ghostsText({best});
        window.command("Demonstration labyrinth");
        EXPECT_TRUE(eventually(
            [&] {
                const auto& frame = window.studio().loop.frame();
                const SceneItem* ghost =
                    frame && frame->scene ? findItem(*frame->scene, labyrinth::kGhostItem) : nullptr;
                return ghost && ghost->name == "Best run" && ghost->visible;
            },
            60s));
    }
    std::ofstream(file) << "{\"labyrinthRuns\":[{";
    StudioWindow window{folder / "session", "scene"};
    window.command("Demonstration labyrinth");
    EXPECT_TRUE(eventually(
        [&] {
            for (const studio::Notice& notice : window.studio().notices.at("project"))
                if (notice.subject == "labyrinth.json" && notice.remedy.contains("labyrinth.damaged-1.json"))
                    return true;
            return false;
        },
        60s));
    EXPECT_EQ(textOf(folder / "session/applications/labyrinth.damaged-1.json"), "{\"labyrinthRuns\":[{");
    EXPECT_TRUE(eventually([&] { return window.studio().loop.program() != nullptr; })) << "it begins anew";
}

} // namespace
} // namespace lumorph::test
