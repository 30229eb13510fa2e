#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

#include "tests/app/process.h"
#include "tests/app/workspace.h"

namespace lumorph::test {
namespace {

constexpr const char* kSvg = R"svg(<svg width="20cm" height="15cm" viewBox="0 0 200 150">
  <g transform="translate(10 10)"><rect width="180" height="130" rx="12"/></g></svg>)svg";

struct Made {
    TemporaryFolder folder;
    [[nodiscard]] std::string operator[](const std::string& name) const { return (folder / name).string(); }
};

TEST(RigNew, WritesWhatRigInfoReads) {
    const Made made;
    const Outcome outcome =
        lumorph({"rig", "new", "flower", "--set", "petals=4", "--set", "diameter=260mm", "-o", made["f.glb"]});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("4 actuators"), std::string::npos) << outcome.out;
    const auto info = lumorph({"rig", "info", made["f.glb"], "--states", "5", "--json"}).json();
    EXPECT_EQ(info["actuators"].size(), 4U);
    EXPECT_EQ(info["actuators"][0]["name"], "petal 1");
    EXPECT_TRUE(info["mesh"]["closed"]);
    EXPECT_EQ(info["shape"]["intersectingStates"], 0);
}

TEST(RigNew, TabletIsTheBundledOne) {
    const Made made;
    ASSERT_EQ(lumorph({"rig", "new", "tablet", "-o", made["t.glb"]}).exitCode, 0);
    EXPECT_EQ(bytesOfFile(made["t.glb"]), bytesOfFile(resource("models/tablet.glb")));
    EXPECT_EQ(lumorph({"rig", "new", "tablet", "-o", "-"}).out, textOfFile(resource("models/tablet.glb")));
}

TEST(RigNew, ListsParameters) {
    const auto list = lumorph({"rig", "new", "phone", "--list", "--json"}).json();
    EXPECT_EQ(list["parameters"][0]["name"], "top");
    EXPECT_EQ(list["parameters"][0]["value"], "cut");
    const auto width = std::ranges::find(list["parameters"], "width", [](const auto& one) { return one["name"]; });
    ASSERT_NE(width, list["parameters"].end());
    EXPECT_EQ((*width)["unit"], "cm");
    EXPECT_EQ((*width)["value"], 7.5);
}

TEST(RigNew, BlankSheetOpens) {
    const Made made;
    ASSERT_EQ(lumorph({"rig", "new", "sheet", "--set", "width=30", "-o", made["s.glb"]}).exitCode, 0);
    const auto info = lumorph({"rig", "info", made["s.glb"], "--json"}).json();
    EXPECT_EQ(info["actuators"].size(), 0U);
    EXPECT_TRUE(info["mesh"]["closed"]);
}

TEST(RigSheet, MakesFlapsOfBendLines) {
    const Made made;
    writeFile(made["o.svg"], std::string(kSvg));
    writeFile(made["b.json"], std::string(R"({"thickness": 0.15, "bends": [
        {"name": "corner", "from": [14, 1], "to": [19, 6], "angle": 80},
        {"name": "tongue", "from": [6, 9], "to": [11, 9], "ends": "free"}]})"));
    const Outcome outcome = lumorph({"rig", "sheet", made["o.svg"], "--bends", made["b.json"], "-o", made["s.glb"]});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto info = lumorph({"rig", "info", made["s.glb"], "--states", "10", "--json"}).json();
    EXPECT_EQ(info["name"], "o");
    EXPECT_EQ(info["actuators"][0]["name"], "corner");
    EXPECT_NEAR(info["actuators"][0]["range"][1].get<double>(), 1.3963, 1e-3);
    EXPECT_EQ(info["shape"]["intersectingStates"], 0);
    EXPECT_EQ(info["shape"]["invertedStates"], 0);
    // The sheet is centred: the corner at the upper right of the page is at +x, away from the viewer.
    EXPECT_NEAR(info["reach"]["max"][0].get<double>(), 0.09, 0.002);
    EXPECT_NEAR(info["reach"]["min"][2].get<double>(), -0.065, 0.002);
}

TEST(RigInfo, SaysWhatGoesWrongInMotionAndFromWhereOn) {
    const Made made;
    ASSERT_EQ(lumorph({"rig", "new", "book", "-o", made["b.glb"]}).exitCode, 0);
    const auto check =
        lumorph({"rig", "info", made["b.glb"], "--states", "10", "--max-speed", "0.2", "--json"}).json()["check"];
    ASSERT_EQ(check["findings"].size(), 2U) << check;
    const auto& found = check["findings"][0];
    EXPECT_EQ(found["kind"], "speed");
    EXPECT_EQ(found["unit"], "m/s");
    EXPECT_EQ(found["actuators"].size(), 1U);
    EXPECT_EQ(found["limit"], 0.2);
    EXPECT_GT(found["amount"], 0.2);
    EXPECT_EQ(found["worst"].size(), 2U);
    const std::string text = lumorph({"rig", "info", made["b.glb"], "--states", "10", "--max-speed", "0.2"}).out;
    EXPECT_NE(text.find("moves a point at"), std::string::npos) << text;
    EXPECT_NE(text.find("Let its full stroke take"), std::string::npos) << text;
    EXPECT_NE(lumorph({"rig", "info", made["b.glb"], "--states", "10", "--max-speed", "1"}).out.find("nothing wrong"),
              std::string::npos);
    EXPECT_EQ(lumorph({"rig", "info", made["b.glb"], "--states", "10", "--max-stretch", "-1"}).exitCode, 2);
}

TEST(RigReport, SaysWhatADeviceCanBe) {
    const Made made;
    std::filesystem::create_directory(made["targets"]);
    ASSERT_EQ(lumorph({"rig", "deform", cutTabletFile(), "--state", "9,21,32,14,13,7", "-o", made["targets/pose.obj"]})
                  .exitCode,
              0);
    std::filesystem::copy(resource("targets/dunes.glb"), made["targets"]);
    const auto report = lumorph({"rig", "report", cutTabletFile(), "--targets", made["targets"], "--json"}).json();
    EXPECT_EQ(report["metrics"].size(), 10U);
    EXPECT_EQ(report["metrics"][6]["key"], "closure");
    EXPECT_TRUE(report["metrics"][6]["light"].is_null());
    EXPECT_EQ(report["references"].size(), 3U);
    EXPECT_EQ(report["loads"].size(), 6U);
    EXPECT_EQ(report["fit"]["best"], "pose");
    EXPECT_EQ(report["fit"]["targets"][1]["state"].dump(), "[9,21,32,14,13,7]");
    EXPECT_GT(report["fit"]["targets"][1]["iou"], 0.99);
    EXPECT_EQ(report["fit"]["byActuators"].size(), 6U);
    const TabletWorkspace w;
    const auto match = lumorph({"match", w.field(), resource("targets/dunes.glb"), "--fit", "--method", "refined",
                                "--budget-ms", "60000", "--json"});
    EXPECT_NEAR(report["fit"]["targets"][0]["iou"].get<double>(), match.json()["iou"].get<double>(), 0.003);
    const std::string text = lumorph({"rig", "report", cutTabletFile(), "--coarse"}).out;
    for (const char* part : {"Zero-crossing", "with light", "pins", "SG90", "bloom", "without"})
        EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST(RigReport, RefusesByName) {
    const Made made;
    std::filesystem::create_directory(made["empty"]);
    ASSERT_EQ(lumorph({"rig", "new", "sheet", "-o", made["s.glb"]}).exitCode, 0);
    const std::string tablet = cutTabletFile();
    const auto expect = [](const Outcome& outcome, int code, const char* part) {
        EXPECT_EQ(outcome.exitCode, code) << outcome.err;
        EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    };
    expect(lumorph({"rig", "report", tablet, "--targets", made["empty"]}), 1, "holds no mesh");
    expect(lumorph({"rig", "report", tablet, "--targets", made["none"]}), 1, "none");
    expect(lumorph({"rig", "report", made["s.glb"]}), 2, "no actuator");
    expect(lumorph({"rig", "report", tablet, "--servo", "AX-12"}), 2, "SG90");
    expect(lumorph({"rig", "report", tablet, "--pixel-mm", "nan"}), 2, "--pixel-mm");
}

/// Targets that are poses of a sheet device with two flaps, and a blank sheet of the same outline.
struct SearchInput : Made {
    SearchInput() {
        const Made& made = *this;
        writeFile(made["o.svg"], std::string(kSvg));
        writeFile(made["b.json"], std::string(R"({"bends": [{"from": [14, 1], "to": [19, 6]},
                                                            {"from": [6, 1], "to": [6, 14]}]})"));
        writeFile(made["none.json"], std::string(R"({"bends": []})"));
        std::filesystem::create_directory(made["t"]);
        EXPECT_EQ(lumorph({"rig", "sheet", made["o.svg"], "--bends", made["b.json"], "-o", made["h.glb"]}).exitCode, 0);
        EXPECT_EQ(lumorph({"rig", "sheet", made["o.svg"], "--bends", made["none.json"], "-o", made["s.glb"]}).exitCode,
                  0);
        EXPECT_EQ(lumorph({"rig", "deform", made["h.glb"], "--state", "20,32", "-o", made["t/one.obj"]}).exitCode, 0);
        EXPECT_EQ(lumorph({"rig", "deform", made["h.glb"], "--state", "32,9", "-o", made["t/two.obj"]}).exitCode, 0);
    }
    [[nodiscard]] std::vector<std::string> command(const std::string& output, const std::string& generations) const {
        return {"rig",          "search", (*this)["s.glb"], "--targets", (*this)["t"], "--generations", generations,
                "--population", "16",     "--servos",       "3",         "-o",         (*this)[output], "--json"};
    }
};

TEST(RigSearch, FindsAFrontAndGoesOn) {
    const SearchInput made;
    const auto found = lumorph(made.command("found", "6")).json();
    ASSERT_GE(found["front"].size(), 1U);
    EXPECT_EQ(found["generations"], 6);
    double fit = 0.0;
    for (const auto& design : found["front"]) {
        EXPECT_GT(design["fit"].get<double>(), fit);
        fit = design["fit"];
        const auto info = lumorph({"rig", "info", design["file"], "--states", "3", "--json"}).json();
        EXPECT_EQ(info["actuators"].size(), design["servos"]);
        EXPECT_TRUE(info["mesh"]["closed"]);
    }
    EXPECT_GT(fit, 0.6); // the hidden device's is 1
    EXPECT_EQ(textOfFile(made["found/front.csv"]).substr(0, 27), "servos,price,fit,file,one,t");
    // In two parts, and from the drawing instead of the rig.
    ASSERT_EQ(lumorph(made.command("parts", "3")).exitCode, 0);
    const auto whole = lumorph(made.command("parts", "6")).json();
    EXPECT_EQ(textOfFile(made["parts/front.csv"]), textOfFile(made["found/front.csv"]));
    EXPECT_EQ(whole["evaluations"], found["evaluations"]);
    for (const auto& design : found["front"]) {
        const std::string name = std::filesystem::path(design["file"].get<std::string>()).filename();
        EXPECT_TRUE(bytesOfFile(made["parts/" + name]) == bytesOfFile(made["found/" + name])) << name;
    }
    std::vector<std::string> drawn = made.command("drawn", "0");
    drawn[2] = made["o.svg"];
    EXPECT_EQ(lumorph(drawn).exitCode, 0);
}

TEST(RigSearch, RefusesByName) {
    const SearchInput made;
    const auto expect = [](const Outcome& outcome, int code, const char* part) {
        EXPECT_EQ(outcome.exitCode, code) << outcome.err;
        EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    };
    ASSERT_EQ(lumorph(made.command("found", "0")).exitCode, 0);
    std::vector<std::string> other = made.command("found", "0");
    other[2] = made["h.glb"];
    expect(lumorph(other), 2, "the search of another rig, 'o'");
    other = made.command("found", "0");
    other.insert(other.end(), {"--seed", "5"});
    expect(lumorph(other), 2, "seed 1");
    other = made.command("found", "0");
    other[2] = resource("models/pin_display.glb");
    expect(lumorph(other), 2, "pin display");
    writeFile(made["file"], std::string("in the way"));
    expect(lumorph(made.command("file", "0")), 1, "file");
}

TEST(RigSearch, FindsTheSameOnTwoRanks) {
    if (!std::filesystem::exists("/usr/bin/mpirun") || !std::filesystem::exists(LUMORPH_BIN_DIR "/liblumorph_mpi.so"))
        GTEST_SKIP() << "no MPI";
    const SearchInput made;
    ASSERT_EQ(lumorph(made.command("alone", "3")).exitCode, 0);
    std::vector<std::string> together{"--allow-run-as-root", "--oversubscribe", "-n", "2", lumorphProgram()};
    for (const std::string& part : made.command("together", "3")) together.push_back(part);
    const Outcome outcome = Process("/usr/bin/mpirun", together).wait();
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_GE(outcome.json()["front"].size(), 1U); // printed once
    for (const std::string& name : filesIn(made["alone"]))
        EXPECT_TRUE(bytesOfFile(made["alone/" + name]) == bytesOfFile(made["together/" + name])) << name;
    // A wrong folder ends all of them.
    std::vector<std::string> wrong = together;
    wrong[7] = made["h.glb"];
    EXPECT_EQ(Process("/usr/bin/mpirun", wrong).wait(std::chrono::seconds(60)).exitCode, 2);
}

TEST(RigSearch, StopsWithAWholeStateAndGoesOn) {
    const SearchInput made;
    const std::vector<std::string> endless = made.command("found", "1000000");
    Process search(lumorphProgram(), endless, {}, Process::ErrorStream::terminal);
    for (int k = 0; k < 600 && !std::filesystem::exists(made["found/search.json"]); ++k)
        (void)search.gatherFor(std::chrono::milliseconds(100));
    (void)search.gatherFor(std::chrono::milliseconds(500));
    search.send(SIGINT);
    const Outcome outcome = search.wait(std::chrono::seconds(20));
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_NE(outcome.err.find("the same command goes on from there"), std::string::npos) << outcome.err;
    EXPECT_EQ(filesIn(made["found"]), std::vector<std::string>{"search.json"});
    const auto found = lumorph(made.command("found", "1")).json();
    EXPECT_GE(found["generations"], 1);
}

// As a power cut ends it, again and again.
TEST(RigSearch, KilledGoesOnToTheSameFront) {
    const SearchInput made;
    ASSERT_EQ(lumorph(made.command("whole", "30")).exitCode, 0);
    const std::vector<std::string> killed = made.command("killed", "30");
    for (int k = 0; k < 4; ++k) {
        Process search(lumorphProgram(), killed);
        for (int wait = 0; wait < 300 && !std::filesystem::exists(made["killed/search.json"]); ++wait)
            (void)search.gatherFor(std::chrono::milliseconds(20));
        (void)search.gatherFor(std::chrono::milliseconds(70 * k));
        search.send(SIGKILL);
        (void)search.wait(std::chrono::seconds(20));
    }
    const auto found = lumorph(killed).json();
    EXPECT_EQ(found["generations"], 30);
    EXPECT_EQ(textOfFile(made["killed/front.csv"]), textOfFile(made["whole/front.csv"]));
    EXPECT_EQ(textOfFile(made["killed/search.json"]), textOfFile(made["whole/search.json"]));
}

/// Runs `lumorph` where no file may grow beyond so many blocks of 512 bytes, which stands for a full disk.
Outcome lumorphOnAFullDisk(int blocks, const std::vector<std::string>& arguments) {
    std::vector<std::string> shell{"-c", "ulimit -f " + std::to_string(blocks) + "; trap '' XFSZ; exec \"$0\" \"$@\"",
                                   lumorphProgram()};
    shell.insert(shell.end(), arguments.begin(), arguments.end());
    return Process("/bin/sh", shell).wait();
}

TEST(RigMaking, FullDiskLeavesWhatWasThere) {
    const SearchInput made;
    ASSERT_EQ(lumorph({"rig", "new", "tablet", "-o", made["old.glb"]}).exitCode, 0);
    ASSERT_EQ(lumorph(made.command("found", "2")).exitCode, 0);
    const auto contents = [&] {
        std::map<std::string, std::string> all;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(made.folder.path()))
            all[entry.path()] = entry.is_regular_file() ? textOfFile(entry.path()) : "folder";
        return all;
    };
    const auto before = contents();
    struct Wrong {
        std::vector<std::string> arguments;
        std::string names;
    };
    for (const Wrong& wrong :
         {Wrong{{"rig", "new", "flower", "-o", made["old.glb"]}, "old.glb"},
          Wrong{{"rig", "sheet", made["o.svg"], "--bends", made["b.json"], "-o", made["new.glb"]}, "new.glb"},
          Wrong{{"rig", "parts", made["old.glb"], "-o", made["parts"]}, "parts"},
          Wrong{made.command("found", "3"), "found"}}) {
        const Outcome outcome = lumorphOnAFullDisk(2, wrong.arguments);
        EXPECT_EQ(outcome.exitCode, 1) << wrong.names << ": " << outcome.err;
        EXPECT_NE(outcome.err.find(wrong.names), std::string::npos) << outcome.err;
        EXPECT_TRUE(contents() == before) << wrong.names;
    }
    EXPECT_EQ(lumorph(made.command("found", "3")).json()["generations"], 3);
}

TEST(RigMaking, RefusesByNameAndLeavesNothing) {
    const Made made;
    writeFile(made["o.svg"], std::string(kSvg));
    writeFile(made["empty.svg"], std::string("<svg><text>sheet</text></svg>"));
    const auto bends = [&](const char* name, const std::string& text) { writeFile(made[name], text); };
    bends("good.json", R"({"bends": []})");
    bends("outside.json", R"({"bends": [{"name": "one", "from": [5, 3], "to": [10, 16]},
                                        {"name": "two", "from": [15, 3], "to": [9, 16]}]})");
    bends("zero.json", R"({"thickness": 0, "bends": []})");
    bends("nan.json", R"({"bends": [{"from": [NaN, 3], "to": [10, 16]}]})");
    bends("huge.json", R"({"bends": [{"from": [1e999, 3], "to": [10, 16]}]})");
    bends("key.json", R"({"bends": [{"form": [1, 3], "to": [10, 16]}]})");
    bends("side.json", R"({"bends": [{"from": [1, 3], "to": [10, 16], "side": "up"}]})");
    bends("short.json", R"({"bends": [{"name": "dot", "from": [10, 7], "to": [10, 7]}]})");
    bends("away.json", R"({"bends": [{"name": "away", "from": [40, 3], "to": [40, 16]}]})");
    std::string many = R"({"bends": [)";
    for (int k = 0; k < 500; ++k) many += std::string(k == 0 ? "" : ",") + R"({"from": [1, 3], "to": [10, 16]})";
    bends("many.json", many + "]}");
    struct Wrong {
        int exitCode;
        std::vector<std::string> arguments;
        const char* says;
    };
    const auto sheet = [&](const char* outline, const char* file) {
        return std::vector<std::string>{"rig", "sheet", made[outline], "--bends", made[file], "-o", made["x.glb"]};
    };
    const auto before = filesIn(made.folder.path());
    for (const Wrong& wrong : {
             Wrong{1, sheet("empty.svg", "good.json"), "empty.svg: it holds no outline"},
             Wrong{1, sheet("good.json", "good.json"), "no SVG drawing"},
             Wrong{1, sheet("missing.svg", "good.json"), "missing.svg"},
             Wrong{2, sheet("o.svg", "outside.json"), "meets bend line 'one' outside the sheet"},
             Wrong{2, sheet("o.svg", "zero.json"), "sheet: thickness"},
             Wrong{1, sheet("o.svg", "nan.json"), "nan.json: it is not valid JSON"},
             Wrong{1, sheet("o.svg", "huge.json"), "huge.json"},
             Wrong{1, sheet("o.svg", "key.json"), "bend 1: it holds 'form'"},
             Wrong{1, sheet("o.svg", "side.json"), "bend 1: side is 'up'"},
             Wrong{2, sheet("o.svg", "many.json"), "500 bend lines are too many"},
             Wrong{2, sheet("o.svg", "short.json"), "'dot'"},
             Wrong{2, sheet("o.svg", "away.json"), "'away'"},
             Wrong{2, {"rig", "new", "chair", "-o", made["x.glb"]}, "'chair': there is no such template"},
             Wrong{2, {"rig", "new", "tablet", "--set", "width=nan", "-o", made["x.glb"]}, "no finite number"},
             Wrong{2,
                   {"rig", "new", "tablet", "--set", "top=cut", "--set", "reach=2", "-o", made["x.glb"]},
                   "would vanish"},
             Wrong{2, {"rig", "new", "tablet", "-o", made["x.obj"]}, "written as .glb"},
             Wrong{2, {"rig", "new", "tablet"}, "--output"},
             Wrong{1, {"rig", "new", "tablet", "-o", made["no/x.glb"]}, "there is no folder"},
         }) {
        const Outcome outcome = lumorph(wrong.arguments);
        EXPECT_EQ(outcome.exitCode, wrong.exitCode) << wrong.says << ": " << outcome.err;
        EXPECT_NE(outcome.err.find(wrong.says), std::string::npos) << outcome.err;
        EXPECT_TRUE(outcome.out.empty()) << outcome.out;
    }
    EXPECT_EQ(filesIn(made.folder.path()), before);
}

TEST(RigParts, WritesSketchAndProfileWithTheWiringsPins) {
    const Made made;
    ASSERT_EQ(lumorph({"rig", "new", "tablet", "-o", made["t.glb"]}).exitCode, 0);
    const auto plan = lumorph({"rig", "parts", made["t.glb"], "-o", made["out"], "--json"}).json();
    EXPECT_EQ(plan["wiring"].size(), 6U);
    const std::string header = textOfFile(made["out/tablet/channels.h"]);
    const auto profile = nlohmann::json::parse(textOfFile(made["out/profile.json"]));
    for (std::size_t k = 0; k < 6; ++k) {
        const auto& row = plan["wiring"][k];
        EXPECT_NE(header.find("{" + std::to_string(row["pin"].get<int>()) + ", "), std::string::npos) << header;
        EXPECT_EQ(profile["servos"][k]["channel"], row["pin"]);
        EXPECT_EQ(profile["servos"][k]["reversed"], row["reversed"]);
        EXPECT_EQ(profile["servos"][k]["pulseMax"], row["pulse"][1]);
    }
    for (const auto& part : plan["parts"])
        EXPECT_TRUE(std::filesystem::exists(made["out/" + part["name"].get<std::string>() + ".stl"])) << part;
}

TEST(RigParts, WritesTheRigAsItsLeversMoveIt) {
    const Made made;
    ASSERT_EQ(lumorph({"rig", "new", "tablet", "--set", "top=cut", "-o", made["t.glb"]}).exitCode, 0);
    const auto plan =
        lumorph({"rig", "parts", made["t.glb"], "-o", made["out"], "--fitted", made["fit.glb"], "--json"}).json();
    const auto info = lumorph({"rig", "info", made["fit.glb"], "--json"}).json();
    const auto profile = nlohmann::json::parse(textOfFile(made["out/profile.json"]));
    int shorter = 0;
    for (std::size_t k = 0; k < 6; ++k) {
        const auto& actuator = info["actuators"][k];
        EXPECT_LE(actuator["range"][1].get<double>(), 1.571) << "radians; as drawn it is a right angle";
        shorter += actuator["range"][1].get<double>() < 1.5 ? 1 : 0;
        EXPECT_EQ(actuator["pulseCurve"], plan["wiring"][k]["pulseCurve"]);
        EXPECT_EQ(profile["servos"][k]["curve"], plan["wiring"][k]["pulseCurve"]);
        EXPECT_EQ(actuator["pulse"][plan["wiring"][k]["reversed"] ? 1 : 0], plan["wiring"][k]["pulse"][0]);
    }
    EXPECT_EQ(shorter, 4) << "corners";
}

TEST(RigParts, LeavesNothingOfWhatFails) {
    const Made made;
    ASSERT_EQ(lumorph({"rig", "new", "cushion", "-o", made["c.glb"]}).exitCode, 0);
    const auto fails = [&](const std::vector<std::string>& more, const char* named) {
        std::vector<std::string> arguments{"rig", "parts", made["c.glb"], "-o", made["out"]};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = lumorph(arguments);
        EXPECT_NE(outcome.exitCode, 0);
        EXPECT_NE(outcome.err.find(named), std::string::npos) << outcome.err;
    };
    fails({"--tolerance", "5mm"}, "tolerance");
    fails({"--tolerance", "wide"}, "--tolerance");
    fails({"--bed", "1mm"}, "print bed");
    fails({"--servo", "SG9000"}, "SG90, MG996R");
    EXPECT_EQ(filesIn(made.folder.path()), std::vector<std::string>{"c.glb"});
}

TEST(LabPlacement, TakesAProjectorByItsName) {
    const std::string tablet = cutTabletFile();
    const auto named = lumorph({"lab", "placement", tablet, "--lens", "optoma gt1080hdr", "--json"}).json();
    const auto typed = lumorph({"lab", "placement", tablet, "--lens", "1920x1080:0.496:0.66", "--json"}).json();
    EXPECT_EQ(named["best"], typed["best"]);
    EXPECT_GT(named["best"]["lit"].get<double>(), 0.8);
    const Outcome unknown = lumorph({"lab", "placement", tablet, "--lens", "Optoma GT1"});
    EXPECT_EQ(unknown.exitCode, 2);
    EXPECT_NE(unknown.err.find("Optoma GT1080HDR"), std::string::npos) << unknown.err;
}

TEST(LabPlacement, BlurFollowsFromTheApertureOrFromWhatWasMeasured) {
    const std::string tablet = cutTabletFile();
    const auto light = [&](std::vector<std::string> more) {
        std::vector<std::string> words{"lab", "placement", tablet, "--json"};
        words.insert(words.end(), more.begin(), more.end());
        return lumorph(words).json()["now"];
    };
    const auto plain = light({});
    EXPECT_FALSE(plain.contains("blurMillimetres")) << "nobody said how wide the lens is";
    const double best = plain["bestFocus"].at(0);
    EXPECT_GT(best, 0.5);
    const auto sharp = light({"--aperture", "8", "--focus", std::to_string(best)});
    const auto before = light({"--aperture", "8", "--focus", std::to_string(0.8 * best)});
    const double blur = before["blurMillimetres"];
    EXPECT_LT(sharp["blurMillimetres"].get<double>(), 0.3 * blur);
    EXPECT_GT(blur, 8.0 * 0.2); // |1 / 0.8 - 1| in the middle, more where light is slanting
    // The same lens by what it was seen to do.
    const double focus = 0.8 * best;
    std::string seen;
    for (const double at : {0.6 * best, 0.75 * best, 0.9 * best, best})
        seen += std::to_string(at) + ":" + std::to_string(8.0 * std::abs(at / focus - 1.0)) + ",";
    EXPECT_NEAR(light({"--blur", seen})["blurMillimetres"].get<double>(), blur, 0.01 * blur);
    for (const char* wrong : {"1.6", "wide", "1:0.1,2:0.1", "1:1,1:1,1:1"}) {
        const Outcome refused = lumorph({"lab", "placement", tablet, "--blur", wrong});
        EXPECT_EQ(refused.exitCode, 2) << wrong;
        EXPECT_NE(refused.err.find("lur"), std::string::npos) << refused.err;
    }
}

} // namespace
} // namespace lumorph::test
