#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <sstream>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/lab/lab.h"
#include "calibration/patterns/capture_order.h"
#include "tests/app/process.h"
#include "tests/app/workspace.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/long_tests.h"
#include "tests/support/procam_capture.h"

namespace lumorph::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string rigFile() { return cutTabletFile(); }

const Rig& tablet() {
    static const Rig rig = cutTablet();
    return rig;
}

/// Looks at the tablet, which is the world; its principal point lies `shift` pixels beside the middle.
CalibratedCamera lookingAtTheTablet(const glm::dvec3& from, glm::ivec2 size, double focal, double shift) {
    CalibratedCamera camera = cameraLookingAt(from, {0.0, 0.03, 0.0}, size, focal);
    camera.cameraFromWorld =
        glm::rotate(glm::dmat4(1.0), std::atan2(shift, focal), glm::dvec3(1.0, 0.0, 0.0)) * camera.cameraFromWorld;
    camera.principal.y += shift;
    return camera;
}

struct TrueDevices {
    std::vector<CalibratedCamera> cameras, projectors;
};

TrueDevices trueDevices(std::size_t count) {
    TrueDevices truth;
    truth.cameras = {lookingAtTheTablet({-0.5, 1.2, 0.7}, {640, 480}, 2300.0, 5.0),
                     lookingAtTheTablet({0.6, 1.1, 0.5}, {640, 480}, 2100.0, 0.0)};
    truth.projectors = {lookingAtTheTablet({0.1, 2.0, 0.4}, {512, 384}, 2100.0, 190.0),
                        lookingAtTheTablet({-0.5, 1.7, -0.5}, {640, 400}, 1950.0, 150.0)};
    truth.cameras[0].distortion = {-0.18, 0.05, 0.0005, -0.0005, 0.0};
    truth.projectors[0].distortion = {-0.05, 0.02, 0.0004, -0.0003, 0.0};
    truth.cameras.resize(count);
    truth.projectors.resize(count);
    return truth;
}

/// What the camera of the lab sees of all patterns, with noise of one grey level.
std::vector<Image> photographs(const std::vector<double>& strokes, const CalibratedCamera& camera,
                               const CalibratedCamera& projector, std::mt19937& random) {
    std::normal_distribution<double> grain(0.0, 1.0);
    LabWorld world;
    world.surfaces = {{deformed(tablet(), strokes), glm::vec3(0.8F)}};
    world.ambient = glm::vec3(0.05F);
    InstalledProjector installed;
    installed.camera = projector;
    installed.peak = 1.0;
    installed.gamma = 1.0;
    world.projectors = {{installed, Image(projector.size)}};
    Lab lab(std::move(world));
    const LabSight sight = lab.look(camera, 3);
    const cv::Size size(projector.size.x, projector.size.y);
    std::vector<Image> images;
    for (const PatternImage& shown : parsePattern("graycode", size).images) {
        const cv::Mat drawn = drawPattern(shown, size);
        Image pattern(projector.size);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x) {
                const std::uint8_t value = drawn.at<std::uint8_t>(y, x);
                pattern.at(x, y) = {value, value, value, 255};
            }
        lab.show(0, pattern);
        const std::vector<glm::vec3> radiance = lab.radiance(sight);
        Image& image = images.emplace_back(camera.size);
        for (std::size_t i = 0; i < radiance.size(); ++i) {
            const double grey = 200.0 * static_cast<double>(radiance[i].g) + grain(random);
            const auto value = static_cast<std::uint8_t>(std::lround(std::clamp(grey, 0.0, 255.0)));
            image.pixels()[i] = {value, value, value, 255};
        }
    }
    return images;
}

/// The tablet at rest and with each flap raised. One pair's images lie in the shots, those of several in CAMERA_i and
/// PROJECTOR_i.
void writeDeviceCapture(const fs::path& folder, const TrueDevices& truth) {
    std::mt19937 random(5);
    std::ostringstream table;
    table << "shot,strokes\n";
    for (std::size_t s = 0; s <= tablet().actuatorCount(); ++s) {
        std::vector<double> strokes(tablet().actuatorCount(), 0.0);
        if (s > 0) strokes[s - 1] = 0.75;
        const std::string name = "shot_" + std::to_string(s);
        table << name;
        for (const double stroke : strokes) table << ", " << stroke;
        table << "\n";
        for (std::size_t c = 0; c < truth.cameras.size(); ++c)
            for (std::size_t p = 0; p < truth.projectors.size(); ++p) {
                const fs::path place = truth.cameras.size() == 1 ? folder / name
                                                                 : folder / name / ("CAMERA_" + std::to_string(c + 1)) /
                                                                       ("PROJECTOR_" + std::to_string(p + 1));
                fs::create_directories(place);
                const auto images = photographs(strokes, truth.cameras[c], truth.projectors[p], random);
                for (std::size_t i = 0; i < images.size(); ++i) writePng(images[i], place / imageName(i));
            }
    }
    writeFile(folder / "states.csv", table.str());
}

/// Root mean square of how far the printed projector puts light beside where it belongs, on the device in three
/// states; its own pixels.
double errorOf(const nlohmann::json& printed, const CalibratedCamera& truth) {
    CalibratedCamera found;
    found.size = truth.size;
    found.focal = {printed["K"][0][0], printed["K"][1][1]};
    found.principal = {printed["K"][0][2], printed["K"][1][2]};
    for (std::size_t i = 0; i < 5; ++i) found.distortion[i] = printed["distortion"][i];
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) found.cameraFromWorld[column][row] = printed["R"][row][column];
        found.cameraFromWorld[3][row] = printed["T"][row];
    }
    double sum = 0.0, count = 0.0;
    for (const double stroke : {0.0, 0.5, 1.0}) {
        const TriangleMesh mesh = deformed(tablet(), std::vector<double>(tablet().actuatorCount(), stroke));
        for (const glm::vec3& vertex : mesh.positions) {
            const auto is = pixelOf(found, glm::dvec3(vertex)), should = pixelOf(truth, glm::dvec3(vertex));
            if (!is || !should) return 1e9;
            sum += glm::dot(*is - *should, *is - *should);
            count += 1.0;
        }
    }
    return std::sqrt(sum / count);
}

class CalibrateDevice : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        writeDeviceCapture(capture(), trueDevices(1));
    }
    static void TearDownTestSuite() { folder_.reset(); }
    static fs::path capture() { return *folder_ / "capture"; }
    static Outcome calibrate(const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{"calibrate", "device",    capture().string(), "--rig",
                                           rigFile(),   "--pattern", "graycode"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return lumorph(arguments);
    }
    static std::unique_ptr<TemporaryFolder> folder_;
};

std::unique_ptr<TemporaryFolder> CalibrateDevice::folder_;

TEST_F(CalibrateDevice, PrintsTheProjectorOfTheLabWithinHalfAPixel) {
    const Outcome outcome = calibrate({"--projector", "beamer=512x384", "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err << outcome.out;
    const nlohmann::json result = outcome.json();
    ASSERT_EQ(result["projectors"].size(), 1U);
    EXPECT_EQ(result["projectors"][0]["name"], "beamer");
    EXPECT_EQ(result["cameras"][0]["name"], "camera");
    EXPECT_EQ(result["cameras"][0]["size"], nlohmann::json({640, 480}));
    const double error = errorOf(result["projectors"][0], trueDevices(1).projectors[0]);
    std::printf("light beside where it belongs by %.3f projector pixels\n", error);
    EXPECT_LE(error, 0.5);
    EXPECT_GT(result["onDevice"], 0.8);
    EXPECT_GT(result["projectors"][0]["sigma"]["fx"], 0.0);
    EXPECT_TRUE(result["warnings"].is_array());
    const Outcome text = calibrate({"--projector", "512x384"});
    EXPECT_EQ(text.exitCode, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("focal length"));
    EXPECT_THAT(text.out, HasSubstr("in the device's frame"));
}

TEST_F(CalibrateDevice, SaysWhatIsWrongWithTheShotsByFileAndLine) {
    const std::string table = textOfFile(capture() / "states.csv");
    const std::string last = table.substr(table.rfind("shot_"));
    const std::pair<std::string, const char*> wrong[] = {
        {table + "shot_9,0,0,0,0,0,0\n", "there is no folder 'shot_9'"},
        {table.substr(0, table.size() - last.size()), "it lacks the shot 'shot_"},
        {table + last, "stands in a line before"},
        {"shot_0,0,0\n", "states.csv, line 1: it has 2 strokes"},
        {"shot,strokes\nshot_0,0,0,nan,0,0,0\n", "states.csv, line 2: 'nan' is no stroke"},
        {"shot_0,0,0,0,0,0,1.5\n", "'1.5' is no stroke"},
        {"shot_0,0,0,0,0,0,\n", "'' is no stroke"},
        {"", "it lacks the shot"},
    };
    for (const auto& [text, why] : wrong) {
        writeFile(capture() / "states.csv", text);
        const Outcome outcome = calibrate({"--projector", "512x384"});
        EXPECT_EQ(outcome.exitCode, 1) << why;
        EXPECT_THAT(outcome.err, HasSubstr(why));
    }
    writeFile(capture() / "states.csv", table);
    EXPECT_EQ(calibrate({"--projector", "512"}).exitCode, 2);
    EXPECT_EQ(calibrate({"--projector", "a=512x384", "--projector", "a=512x384"}).exitCode, 2);
    const Outcome two = calibrate({"--projector", "a=512x384", "--projector", "b=512x384"});
    EXPECT_EQ(two.exitCode, 1);
    EXPECT_THAT(two.err, HasSubstr("several were named"));
}

TEST_F(CalibrateDevice, RefusesFlapsThatStandOtherwiseAndImagesThatAreMissing) {
    const fs::path states = capture() / "states.csv";
    const std::string table = textOfFile(states);
    std::string exchanged = "shot,strokes\nshot_0,0,0,0,0,0,0\n";
    for (int s = 1; s <= 6; ++s) {
        exchanged += "shot_" + std::to_string(s);
        for (int i = 1; i <= 6; ++i) exchanged += i == 7 - s ? ",0.75" : ",0";
        exchanged += "\n";
    }
    writeFile(states, exchanged);
    const Outcome other = calibrate({"--projector", "512x384", "--json"});
    EXPECT_EQ(other.exitCode, 1);
    EXPECT_EQ(other.json()["refused"]["cause"], "model_does_not_fit");
    EXPECT_THAT(other.err, HasSubstr("flaps stand"));
    writeFile(states, table);
    const fs::path image = capture() / "shot_3" / imageName(7), aside = *folder_ / "aside.png";
    fs::rename(image, aside);
    const Outcome missing = calibrate({"--projector", "512x384", "--json"});
    fs::rename(aside, image);
    EXPECT_EQ(missing.exitCode, 1);
    EXPECT_EQ(missing.json()["refused"]["cause"], "missing_image");
    EXPECT_THAT(missing.err, HasSubstr("shot_3"));
    const Outcome size = calibrate({"--projector", "300x384", "--json"}); // as many patterns
    EXPECT_EQ(size.exitCode, 1);
    EXPECT_EQ(size.json()["refused"]["cause"], "projector_size");
}

/// From nothing, by the program alone: what it photographs in its lab, it calibrates.
TEST(CalibrateDeviceInTheLab, ACaptureOfTheLabGivesItsProjectorBack) {
    const TemporaryFolder folder;
    const std::string at = (folder / "capture").string();
    const Outcome taken =
        lumorph({"lab", "capture", "--device", rigFile(), "--size", "960x768", "--seed", "3", "-o", at, "--json"});
    ASSERT_EQ(taken.exitCode, 0) << taken.err;
    EXPECT_EQ(taken.json()["shots"], 7);
    const auto size = taken.json()["projector"];
    const std::string projector = size[0].dump() + "x" + size[1].dump();
    const Outcome outcome =
        lumorph({"calibrate", "device", at, "--rig", rigFile(), "--projector", projector, "--json"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err << outcome.out;
    const nlohmann::json truth = nlohmann::json::parse(textOfFile(folder / "capture/truth.json"));
    CalibratedCamera should;
    const nlohmann::json& is = truth["projector"];
    should.size = {size[0], size[1]};
    should.focal = {is["K"][0][0], is["K"][1][1]};
    should.principal = {is["K"][0][2], is["K"][1][2]};
    for (std::size_t i = 0; i < 5; ++i) should.distortion[i] = is["distortion"][i];
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) should.cameraFromWorld[column][row] = is["R"][row][column];
        should.cameraFromWorld[3][row] = is["T"][row];
    }
    const double error = errorOf(outcome.json()["projectors"][0], should);
    std::printf("light beside where it belongs by %.3f projector pixels\n", error);
    EXPECT_LE(error, 0.5);

    EXPECT_EQ(lumorph({"lab", "capture", "-o", (folder / "none").string()}).exitCode, 2);
    EXPECT_EQ(
        lumorph({"lab", "capture", "--device", rigFile(), "--board", "chess:9x7:25", "-o", (folder / "none").string()})
            .exitCode,
        2);
    EXPECT_EQ(lumorph({"lab", "capture", "--device", rigFile(), "-o", at}).exitCode, 2) << "the folder is not empty";
    EXPECT_FALSE(fs::exists(folder / "none"));
}

TEST(CalibrateDevices, SeveralLieInFoldersByCameraAndProjector) {
    if (!longTests()) GTEST_SKIP() << "1,000 pictures: LUMORPH_LONG_TESTS=1 takes them";
    const TemporaryFolder folder;
    const TrueDevices truth = trueDevices(2);
    writeDeviceCapture(folder / "capture", truth);
    std::vector<std::string> arguments{
        "calibrate",           "device",      (folder / "capture").string(), "--rig", rigFile(), "--projector",
        "PROJECTOR_1=512x384", "--projector", "PROJECTOR_2=640x400",         "--json"};
    const Outcome outcome = lumorph(arguments);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.json()["cameras"][1]["name"], "CAMERA_2");
    for (std::size_t p = 0; p < 2; ++p) {
        const double error = errorOf(outcome.json()["projectors"][p], truth.projectors[p]);
        std::printf("light beside where it belongs by %.3f projector pixels\n", error);
        EXPECT_LE(error, 0.5);
    }
    fs::remove_all(folder / "capture/shot_2/CAMERA_1/PROJECTOR_2");
    const Outcome lacking = lumorph(arguments);
    EXPECT_EQ(lacking.exitCode, 1);
    EXPECT_THAT(lacking.err, HasSubstr("it lacks the images of projector 'PROJECTOR_2' by camera 'CAMERA_1'"));
    arguments[6] = "other=512x384";
    EXPECT_THAT(lumorph(arguments).err, HasSubstr("no projector of this name"));
}

} // namespace
} // namespace lumorph::test
