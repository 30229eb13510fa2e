#include "app/output/video_writer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <system_error>

#include <unistd.h>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "core/base/error.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

constexpr int kMinSide = 16;
constexpr int kMaxSide = 8192;

/// The encoder tells the kind of file by its ending, so the temporary keeps it.
fs::path temporaryBeside(const fs::path& file) {
    static std::atomic<unsigned> counter{0};
    return file.parent_path() / (".lumorph-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".mp4");
}

void checkSize(glm::ivec2 size) {
    const auto wrong = [](int side) { return side < kMinSide || side > kMaxSide || side % 2 != 0; };
    if (wrong(size.x) || wrong(size.y))
        throw InvalidInput("video of " + std::to_string(size.x) + " x " + std::to_string(size.y) + " pixels",
                           "a video needs even sides from 16 to 8192 pixels", "choose another size");
}

void checkFile(const fs::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    if (ending != ".mp4")
        throw InvalidInput(file.string(), "a video is written as MP4", "choose a name that ends in .mp4");
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        throw DeviceError(file.string(), "its folder is not there or may not be written to",
                          "choose another place, or check its permissions");
}

[[noreturn]] void failIncomplete(const fs::path& file, const fs::path& written) {
    std::error_code error;
    const fs::space_info space = fs::space(written.has_parent_path() ? written.parent_path() : ".", error);
    // The encoder needs its index written at the end; what is left then may be a little more than nothing.
    if (!error && space.available < (std::uintmax_t{4} << 20U))
        throw DeviceError(file.string(), "cannot be written: the disk is full",
                          "free some disk space, or save to another place");
    throw DeviceError(file.string(), "the video that was written cannot be read again",
                      "choose a smaller size or another place");
}

/// Whether the file opens and holds this many frames of this size.
bool holds(const fs::path& file, int frames, glm::ivec2 size) {
    cv::VideoCapture capture(file.string(), cv::CAP_FFMPEG);
    cv::Mat first;
    return capture.isOpened() && static_cast<int>(capture.get(cv::CAP_PROP_FRAME_COUNT)) == frames &&
           capture.read(first) && first.cols == size.x && first.rows == size.y;
}

} // namespace

struct VideoWriter::Data {
    fs::path file;
    fs::path temporary;
    glm::ivec2 size{0};
    cv::VideoWriter writer;
    cv::Mat picture;
    int frames = 0;
};

VideoWriter::VideoWriter(fs::path file, glm::ivec2 size, double framesPerSecond) : data_(std::make_unique<Data>()) {
    checkSize(size);
    if (!(framesPerSecond >= 1.0 && framesPerSecond <= 240.0))
        throw InvalidInput("frame rate of the video", "it must be 1 to 240 frames a second",
                           "give a rate in that range");
    checkFile(file);
    data_->file = std::move(file);
    data_->temporary = temporaryBeside(data_->file);
    data_->size = size;
    data_->picture.create(size.y, size.x, CV_8UC3);
    for (const auto& code : {std::array{'a', 'v', 'c', '1'}, std::array{'m', 'p', '4', 'v'}})
        if (data_->writer.open(data_->temporary.string(), cv::CAP_FFMPEG,
                               cv::VideoWriter::fourcc(code[0], code[1], code[2], code[3]), framesPerSecond,
                               cv::Size(size.x, size.y)))
            return;
    std::error_code ignored;
    fs::remove(data_->temporary, ignored);
    throw DeviceError(data_->file.string(), "no video encoder for MP4 could be started",
                      "install the packages libopencv-videoio406 and libavcodec59, or choose a smaller size");
}

VideoWriter::~VideoWriter() {
    data_->writer.release();
    std::error_code ignored;
    fs::remove(data_->temporary, ignored);
}

void VideoWriter::add(const Image& frame) {
    if (frame.size() != data_->size)
        throw InvalidInput("frame of the video", "it has another size than the video", "draw it in the video's size");
    for (int y = 0; y < data_->size.y; ++y) {
        auto* row = data_->picture.ptr<cv::Vec3b>(y);
        for (int x = 0; x < data_->size.x; ++x) {
            const Image::Pixel& pixel = frame.at(x, y);
            row[x] = {pixel[2], pixel[1], pixel[0]};
        }
    }
    data_->writer.write(data_->picture);
    ++data_->frames;
}

int VideoWriter::frames() const noexcept { return data_->frames; }

void VideoWriter::finish() {
    if (data_->frames == 0)
        throw InvalidInput(data_->file.string(), "a video needs at least one frame", "make it longer");
    data_->writer.release();
    // The encoder keeps quiet about a disk that refuses; what counts is what can be read again.
    if (!holds(data_->temporary, data_->frames, data_->size)) failIncomplete(data_->file, data_->temporary);
    std::error_code error;
    fs::rename(data_->temporary, data_->file, error);
    if (error)
        throw DeviceError(data_->file.string(), "cannot be written: " + error.message(),
                          "choose another place, or check its permissions");
}

glm::ivec2 evenSize(glm::ivec2 size) noexcept {
    return {std::max(kMinSide, size.x - size.x % 2), std::max(kMinSide, size.y - size.y % 2)};
}

} // namespace lumorph
