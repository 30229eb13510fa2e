#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "app/output/video_writer.h"
#include "app/workspaces/common/field_output.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/resources.h"
#include "core/geometry/mesh_file.h"
#include "core/mdf/builder.h"
#include "core/mdf/field_file.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/cut_tablet.h"
#include "tests/support/small_rigs.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace lumorph::studio {
namespace {

/// What a player hears of an MP4: samples of each channel.
struct HeardFilm {
    int rate = 0;
    std::vector<std::vector<float>> channels;
};

/// Empty channels where it has no sound.
HeardFilm heardIn(const std::string& file) {
    HeardFilm heard;
    AVFormatContext* film = nullptr;
    if (avformat_open_input(&film, file.c_str(), nullptr, nullptr) < 0) return heard;
    avformat_find_stream_info(film, nullptr);
    const AVCodec* codec = nullptr;
    const int stream = av_find_best_stream(film, AVMEDIA_TYPE_AUDIO, -1, -1, &codec, 0);
    if (stream >= 0) {
        AVCodecContext* decoder = avcodec_alloc_context3(codec);
        avcodec_parameters_to_context(decoder, film->streams[stream]->codecpar);
        avcodec_open2(decoder, codec, nullptr);
        heard.rate = decoder->sample_rate;
        heard.channels.resize(static_cast<std::size_t>(decoder->ch_layout.nb_channels));
        AVPacket* packet = av_packet_alloc();
        AVFrame* frame = av_frame_alloc();
        for (bool more = true; more;) {
            more = av_read_frame(film, packet) >= 0;
            if (more && packet->stream_index != stream) {
                av_packet_unref(packet);
                continue;
            }
            avcodec_send_packet(decoder, more ? packet : nullptr);
            av_packet_unref(packet);
            while (avcodec_receive_frame(decoder, frame) >= 0)
                for (std::size_t c = 0; c < heard.channels.size(); ++c) {
                    const auto* samples = reinterpret_cast<const float*>(frame->extended_data[c]);
                    heard.channels[c].insert(heard.channels[c].end(), samples, samples + frame->nb_samples);
                }
        }
        av_frame_free(&frame);
        av_packet_free(&packet);
        avcodec_free_context(&decoder);
    }
    avformat_close_input(&film);
    return heard;
}

/// Hertz of a tone, by how often it goes through zero.
double pitchOf(const std::vector<float>& samples, int rate) {
    int crossings = 0;
    for (std::size_t k = 1; k < samples.size(); ++k) crossings += samples[k - 1] < 0.0F && samples[k] >= 0.0F ? 1 : 0;
    return static_cast<double>(crossings) * rate / static_cast<double>(samples.size());
}

namespace fs = std::filesystem;

/// A folder of its own, gone after the test.
class Exports : public testing::Test {
protected:
    [[nodiscard]] fs::path file(const std::string& name) const { return folder_ / name; }
    [[nodiscard]] std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_.path()))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }

private:
    TemporaryFolder folder_;
};

std::shared_ptr<const MatchField> exportedField() {
    static const auto field = std::make_shared<const MatchField>(
        buildField(test::cushionRig(), {.resolution = 14, .levels = 6, .samples = 8, .seed = 3, .threads = 1}));
    return field;
}

/// A frame as the loop would hand it over, with an estimate that is behind the wish.
MatchFrame cushionFrame() {
    MatchFrame frame;
    frame.field = exportedField();
    frame.rig = std::make_shared<const Rig>(frame.field->rig);
    frame.wanted = {Level{5}, Level{3}, Level{0}};
    frame.wantedStrokes = {1.0, 0.6, 0.0};
    frame.estimatedStrokes = {0.4, 0.25, 0.125};
    frame.iouWanted = 0.875;
    frame.iouEstimated = 0.5;
    frame.seconds = 1.25;
    return frame;
}

std::string exportedText(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::vector<std::string>> rowsOf(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
        rows.emplace_back();
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    }
    return rows;
}

/// A picture of one colour.
Image plain(glm::ivec2 size, std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
    return Image(size, {red, green, blue, 255});
}

struct Video {
    int frames = 0;
    cv::Size size;
    double rate = 0.0;
    std::vector<cv::Scalar> means; ///< blue, green, red of each frame
};

Video videoOf(const fs::path& path) {
    cv::VideoCapture capture(path.string(), cv::CAP_FFMPEG);
    Video video;
    video.rate = capture.get(cv::CAP_PROP_FPS);
    for (cv::Mat picture; capture.read(picture); ++video.frames) {
        video.size = picture.size();
        video.means.push_back(cv::mean(picture));
    }
    return video;
}

TEST_F(Exports, FilmWithSoundIsHeardAsItWasGiven) {
    constexpr int kRate = 48'000;
    VideoWriter writer(file("tones.mp4"), {64, 48}, 30.0);
    for (int k = 0; k < 60; ++k) {
        writer.add(Image({64, 48}, {static_cast<std::uint8_t>(4 * k), 40, 90, 255}));
        std::vector<std::int16_t> samples;
        for (int i = 0; i < kRate / 30; ++i) {
            const double t = (k * (kRate / 30) + i) / static_cast<double>(kRate);
            samples.push_back(static_cast<std::int16_t>(9000.0 * std::sin(2.0 * std::numbers::pi * 440.0 * t)));
            samples.push_back(static_cast<std::int16_t>(3000.0 * std::sin(2.0 * std::numbers::pi * 990.0 * t)));
        }
        writer.addSound(samples);
    }
    writer.finish();
    EXPECT_THAT(files(), testing::ElementsAre("tones.mp4")) << "and nothing beside it";
    cv::VideoCapture shown(file("tones.mp4").string(), cv::CAP_FFMPEG);
    EXPECT_EQ(shown.get(cv::CAP_PROP_FRAME_COUNT), 60.0);
    EXPECT_NEAR(shown.get(cv::CAP_PROP_FPS), 30.0, 0.01);
    const HeardFilm heard = heardIn(file("tones.mp4").string());
    ASSERT_EQ(heard.channels.size(), 2U);
    EXPECT_EQ(heard.rate, kRate);
    for (const auto& channel : heard.channels) EXPECT_NEAR(static_cast<double>(channel.size()) / kRate, 2.0, 0.06);
    EXPECT_NEAR(pitchOf(heard.channels[0], kRate), 440.0, 14.0) << "left";
    EXPECT_NEAR(pitchOf(heard.channels[1], kRate), 990.0, 30.0) << "right";

    VideoWriter silent(file("silent.mp4"), {64, 48}, 30.0);
    silent.add(Image({64, 48}, {10, 40, 90, 255}));
    silent.addSound(std::vector<std::int16_t>(3200, 0));
    silent.finish();
    EXPECT_TRUE(heardIn(file("silent.mp4").string()).channels.empty());
}

TEST_F(Exports, AShapeReadBackIsTheDeformedRigInEveryFormat) {
    const MatchFrame frame = cushionFrame();
    for (const bool estimated : {true, false}) {
        const TriangleMesh expected = deformed(*frame.rig, estimated ? frame.estimatedStrokes : frame.wantedStrokes);
        const Box box = boundingBox(expected.positions);
        for (const char* name : {"shape.obj", "shape.glb", "shape.stl"}) {
            SCOPED_TRACE(name);
            writeShape(frame, estimated, file(name));
            const TriangleMesh read = readMesh(file(name));
            EXPECT_EQ(read.triangles.size(), expected.triangles.size());
            EXPECT_NEAR(signedVolume(read) / signedVolume(expected), 1.0, 1e-4);
            const Box readBox = boundingBox(read.positions);
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(readBox.min[axis], box.min[axis], 1e-6);
                EXPECT_NEAR(readBox.max[axis], box.max[axis], 1e-6);
            }
        }
    }
    const double estimated = signedVolume(deformed(*frame.rig, frame.estimatedStrokes));
    EXPECT_GT(signedVolume(readMesh(file("shape.obj"))), 1.02 * estimated) << "the wish is the higher shape";
}

TEST_F(Exports, AFieldFileHoldsTheField) {
    writeFieldFile(exportedField()->field, file("cushion.mdf"));
    EXPECT_EQ(parseField(readFile(file("cushion.mdf"), std::size_t{1} << 30), "cushion.mdf"), exportedField()->field);
    EXPECT_THAT(files(), testing::ElementsAre("cushion.mdf"));
}

TEST_F(Exports, GridsStandInAFolderOfTheirOwnAndReplaceNothing) {
    const Field& field = exportedField()->field;
    const fs::path first = writeFieldGrids(field, file(""));
    const fs::path second = writeFieldGrids(field, file(""));
    EXPECT_NE(first, second);
    EXPECT_EQ(files().size(), 2U) << "nothing temporary is left";
    const std::string text = exportedText(first / "actuator-1-v0.nrrd");
    const glm::ivec3& d = field.frame.dimensions;
    std::ostringstream sizes;
    sizes << "sizes: " << d.x << " " << d.y << " " << d.z;
    EXPECT_THAT(text, testing::StartsWith("NRRD0004\n"));
    EXPECT_THAT(text, testing::HasSubstr(sizes.str()));
    const std::size_t data = text.find("\n\n") + 2;
    ASSERT_EQ(text.size() - data, field.frame.voxelCount());
    const std::vector<Ramp> ramps = denseRamps(field, 1);
    int changed = 0;
    for (int z = 0; z < d.z; ++z)
        for (int y = 0; y < d.y; ++y)
            for (int x = 0; x < d.x; ++x) {
                const auto byte =
                    static_cast<std::uint8_t>(text[data + static_cast<std::size_t>((z * d.y + y) * d.x + x)]);
                ASSERT_EQ(byte, ramps[field.voxelIndex(x, y, z)].v0) << x << " " << y << " " << z;
                changed += byte != kUnchanged ? 1 : 0;
            }
    EXPECT_GT(changed, 20);
}

TEST_F(Exports, ACancelledExportOfGridsLeavesNothing) {
    std::stop_source stop;
    const Progress progress(
        [&](double fraction, std::string_view) {
            if (fraction > 0.2) stop.request_stop();
        },
        stop.get_token());
    EXPECT_THROW((void)writeFieldGrids(exportedField()->field, file(""), progress), Cancelled);
    EXPECT_THAT(files(), testing::IsEmpty());
}

TEST_F(Exports, TargetVoxelsFillTheTargetWhereItIsPlaced) {
    MatchFrame frame = cushionFrame();
    const VoxelFrame& voxels = frame.field->field.frame;
    const Box box = voxels.box();
    auto target = std::make_shared<MatchTarget>();
    target->solid = makeTarget(test::boxMesh(glm::vec3(-1.0F), glm::vec3(1.0F)));
    target->box = boundingBox(target->solid.mesh.positions);
    frame.target = target;
    // Half the frame along each axis, in its middle.
    const glm::vec3 scale = 0.25F * box.size();
    frame.deviceFromTarget = glm::mat4(1.0F);
    for (int axis = 0; axis < 3; ++axis) {
        frame.deviceFromTarget[axis][axis] = scale[axis];
        frame.deviceFromTarget[3][axis] = box.centre()[axis];
    }
    writeTargetVoxels(frame, file("target.nrrd"));
    const std::string text = exportedText(file("target.nrrd"));
    const std::size_t data = text.find("\n\n") + 2;
    ASSERT_EQ(text.size() - data, voxels.voxelCount());
    const glm::ivec3& d = voxels.dimensions;
    for (int z = 0; z < d.z; ++z)
        for (int y = 0; y < d.y; ++y)
            for (int x = 0; x < d.x; ++x) {
                const glm::dvec3 offset = glm::abs(voxels.centre(x, y, z) - glm::dvec3(box.centre()));
                const glm::dvec3 margin = glm::abs(offset - glm::dvec3(scale));
                if (std::min({margin.x, margin.y, margin.z}) < 1e-5) continue; // on the very surface
                const bool inside = offset.x < scale.x && offset.y < scale.y && offset.z < scale.z;
                const char byte = text[data + static_cast<std::size_t>((z * d.y + y) * d.x + x)];
                ASSERT_EQ(byte != 0, inside) << x << " " << y << " " << z;
            }
}

TEST_F(Exports, TheTableOfNowHasTheLevelsStrokesAndIoUOfTheFrame) {
    const MatchFrame frame = cushionFrame();
    const auto rows = rowsOf(tableOfNow(frame));
    ASSERT_EQ(rows.size(), 2U);
    ASSERT_EQ(rows[0].size(), 3 + 2 * frame.rig->actuatorCount());
    ASSERT_EQ(rows[1].size(), rows[0].size());
    EXPECT_THAT(rows[0][3], testing::HasSubstr(frame.rig->actuators()[0].name));
    const std::vector<double> expected{1.25, 0.875, 0.5, 5, 0.4, 3, 0.25, 0, 0.125};
    for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(std::stod(rows[1][k]), expected[k], 1e-6) << k;
}

TEST_F(Exports, TheTableOfAClipMatchesWhereTheTargetIsPlaced) {
    const auto field = std::make_shared<const MatchField>(
        buildField(test::cutTablet(), {.resolution = 12, .levels = 9, .samples = 8}));
    MatchFrame frame;
    frame.field = field;
    frame.rig = std::make_shared<const Rig>(field->rig);
    frame.target = readMatchTarget(resourceFile("targets/swell.glb"));
    const Placement placement = fitPlacement(field->field, frame.target->box);
    Placement away = placement;
    away.translation.x += 10.0F;
    const auto placed = rowsOf(tableOfClip(frame, placement, MatchMethod::voting, Microseconds(0)));
    const auto beside = rowsOf(tableOfClip(frame, away, MatchMethod::voting, Microseconds(0)));
    ASSERT_EQ(placed.size(), 2 + static_cast<std::size_t>(std::ceil(30.0 * frame.target->duration)));
    ASSERT_EQ(placed.size(), beside.size());
    double moved = 0.0;
    double rested = 0.0;
    for (std::size_t row = 1; row < placed.size(); ++row)
        for (std::size_t column = 3; column < placed[row].size(); column += 2) {
            moved += std::stod(placed[row][column]);
            rested += std::stod(beside[row][column]);
        }
    EXPECT_GT(moved, 10.0);
    EXPECT_EQ(rested, 0.0) << "a target that stands elsewhere moves nothing";
}

TEST_F(Exports, APictureShowsAllThatAWiderViewShowsAndNoMarks) {
    auto scene = std::make_shared<ViewportScene>();
    scene->surfaces.emplace_back().outlined = true;
    ViewCamera camera;
    camera.distance = 0.5;
    PictureStyle style;
    style.size = {1000, 1000};
    style.theme = Theme::light;
    style.grid = false;
    const FrameRequest square = pictureRequest(scene, camera, 1.6, style);
    EXPECT_NEAR(square.camera.distance, 0.8, 1e-9) << "as wide as the view, which was 1.6 times as wide as high";
    EXPECT_FALSE(square.scene->surfaces.front().outlined);
    EXPECT_EQ(square.scene->theme, Theme::light);
    EXPECT_FALSE(square.scene->grid);
    EXPECT_TRUE(scene->surfaces.front().outlined) << "the view's own scene stays as it is";
    style.size = {2000, 1000};
    EXPECT_NEAR(pictureRequest(scene, camera, 1.6, style).camera.distance, 0.5, 1e-9);
}

TEST_F(Exports, PicturesKeepTheirPixelsOnTheWayToAFile) {
    QImage picture(5, 3, QImage::Format_RGB32);
    picture.fill(QColor(200, 100, 50));
    picture.setPixelColor(4, 2, QColor(1, 2, 3));
    const Image image = imageOf(picture);
    writePng(image, file("p.png"));
    const Image read = readPng(file("p.png"));
    ASSERT_EQ(read.size(), glm::ivec2(5, 3));
    EXPECT_EQ(read.at(0, 0), (Image::Pixel{200, 100, 50, 255}));
    EXPECT_EQ(read.at(4, 2), (Image::Pixel{1, 2, 3, 255}));
    EXPECT_EQ(pictureOf(image).pixelColor(4, 2), QColor(1, 2, 3));
}

TEST_F(Exports, AVideoOpensAgainWithEveryFrame) {
    VideoWriter video(file("colors.mp4"), {320, 200}, 25.0);
    for (int k = 0; k < 30; ++k)
        video.add(plain({320, 200}, static_cast<std::uint8_t>(8 * k), 120, static_cast<std::uint8_t>(240 - 8 * k)));
    EXPECT_FALSE(fs::exists(file("colors.mp4"))) << "it has its name only when it is whole";
    video.finish();
    EXPECT_THAT(files(), testing::ElementsAre("colors.mp4"));
    const Video read = videoOf(file("colors.mp4"));
    ASSERT_EQ(read.frames, 30);
    EXPECT_EQ(read.size, cv::Size(320, 200));
    EXPECT_NEAR(read.rate, 25.0, 0.01);
    for (std::size_t k = 0; k < 30; ++k) {
        EXPECT_NEAR(read.means[k][2], 8.0 * static_cast<double>(k), 8.0) << k;
        EXPECT_NEAR(read.means[k][1], 120.0, 8.0) << k;
        EXPECT_NEAR(read.means[k][0], 240.0 - 8.0 * static_cast<double>(k), 8.0) << k;
    }
}

TEST_F(Exports, AVideoRefusesWhatCannotBeOne) {
    EXPECT_THROW(VideoWriter(file("a.mp4"), {321, 200}, 25.0), InvalidInput);
    EXPECT_THROW(VideoWriter(file("a.mp4"), {8, 8}, 25.0), InvalidInput);
    EXPECT_THROW(VideoWriter(file("a.mp4"), {320, 200}, 0.0), InvalidInput);
    EXPECT_THROW(VideoWriter(file("a.avi"), {320, 200}, 25.0), InvalidInput);
    EXPECT_THROW(VideoWriter(file("nowhere/a.mp4"), {320, 200}, 25.0), DeviceError);
    VideoWriter empty(file("a.mp4"), {320, 200}, 25.0);
    EXPECT_THROW(empty.finish(), InvalidInput);
    EXPECT_THROW(empty.add(plain({322, 200}, 0, 0, 0)), InvalidInput);
}

TEST_F(Exports, AVideoThatTheDiskRefusesLeavesTheOlderOne) {
    std::ofstream(file("full.mp4")) << "older";
    VideoWriter video(file("full.mp4"), {640, 480}, 30.0);
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{20'000, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    std::mt19937 random(5);
    Image noise({640, 480});
    for (int k = 0; k < 60; ++k) {
        for (Image::Pixel& pixel : noise.pixels()) pixel[0] = pixel[1] = static_cast<std::uint8_t>(random());
        video.add(noise);
    }
    EXPECT_THROW(video.finish(), DeviceError);
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(exportedText(file("full.mp4")), "older");
}

/// Paints a plain picture whose red says where the camera has turned to.
QImage paintYaw(const FrameRequest& request, const Progress&) {
    QImage image(request.pixels, QImage::Format_RGB32);
    image.fill(QColor(static_cast<int>(request.camera.yaw.inRadians() / (2.0 * std::numbers::pi) * 250.0), 60, 60));
    return image;
}

TEST_F(Exports, ATurntableTurnsOnceAndIsAsLongAsAsked) {
    Turntable turntable;
    turntable.seconds = 1.0;
    turntable.framesPerSecond = 20.0;
    turntable.style.size = {161, 101}; // made even
    turntable.style.grid = false;
    writeTurntable(turntable, std::make_shared<ViewportScene>(), {}, 1.6, paintYaw, file("turn.mp4"));
    const Video read = videoOf(file("turn.mp4"));
    ASSERT_EQ(read.frames, 20);
    EXPECT_EQ(read.size, cv::Size(160, 100));
    for (std::size_t k = 0; k < 20; ++k) EXPECT_NEAR(read.means[k][2], 12.5 * static_cast<double>(k), 8.0) << k;
}

TEST_F(Exports, ACancelledTurntableLeavesNothing) {
    std::stop_source stop;
    int painted = 0;
    const Painter paint = [&](const FrameRequest& request, const Progress& progress) {
        if (++painted == 3) stop.request_stop();
        return paintYaw(request, progress);
    };
    Turntable turntable;
    EXPECT_THROW(writeTurntable(turntable, std::make_shared<ViewportScene>(), {}, 1.6, paint, file("turn.mp4"),
                                Progress({}, stop.get_token())),
                 Cancelled);
    EXPECT_EQ(painted, 3);
    EXPECT_THAT(files(), testing::IsEmpty());
}

} // namespace
} // namespace lumorph::studio
