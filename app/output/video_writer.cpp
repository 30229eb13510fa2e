#include "app/output/video_writer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "app/output/sound_track.h"
#include "app/sound/synthesis.h"
#include "core/base/error.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

constexpr int kMinSide = 16;
constexpr int kMaxSide = 8192;

fs::path temporaryBeside(const fs::path& file) {
    static std::atomic<unsigned> counter{0};
    return file.parent_path() / (".lumorph-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".mp4");
}

/// A file without a name, as long as it is open; where the file system has no such files, one with a name for the time
/// being.
class Unnamed {
public:
    /// Beside `file`.
    explicit Unnamed(const fs::path& file) : beside_(temporaryBeside(file)) {
        const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
        constexpr mode_t kMode = 0666; // less the user's mask
        descriptor_ = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kMode);
    }
    ~Unnamed() {
        removeName();
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    Unnamed(const Unnamed&) = delete;
    Unnamed& operator=(const Unnamed&) = delete;
    Unnamed(Unnamed&& other) noexcept
        : beside_(std::exchange(other.beside_, {})), descriptor_(std::exchange(other.descriptor_, -1)) {}
    Unnamed& operator=(Unnamed&&) = delete;

    /// A name with the ending by which the encoder knows the kind of file, for it to open; `opened` takes it away.
    [[nodiscard]] std::string nameForEncoder() const {
        if (descriptor_ >= 0 && ::symlink(content().c_str(), beside_.c_str()) != 0) return content();
        return beside_.string();
    }
    void opened() const {
        if (descriptor_ >= 0) removeName();
    }
    /// Where it can be read.
    [[nodiscard]] std::string content() const {
        return descriptor_ >= 0 ? "/proc/self/fd/" + std::to_string(descriptor_) : beside_.string();
    }
    /// The folder it is in, for its disk.
    [[nodiscard]] const fs::path& beside() const noexcept { return beside_; }
    /// Takes the place of what may be there.
    [[nodiscard]] std::error_code moveTo(const fs::path& file) const {
        if (descriptor_ >= 0 &&
            ::linkat(AT_FDCWD, content().c_str(), AT_FDCWD, beside_.c_str(), AT_SYMLINK_FOLLOW) != 0)
            return {errno, std::generic_category()};
        std::error_code error;
        fs::rename(beside_, file, error);
        return error;
    }

private:
    void removeName() const {
        std::error_code ignored;
        fs::remove(beside_, ignored);
    }

    fs::path beside_;
    int descriptor_ = -1;
};

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
bool holds(const std::string& file, int frames, glm::ivec2 size) {
    cv::VideoCapture capture(file, cv::CAP_FFMPEG);
    cv::Mat first;
    return capture.isOpened() && static_cast<int>(capture.get(cv::CAP_PROP_FRAME_COUNT)) == frames &&
           capture.read(first) && first.cols == size.x && first.rows == size.y;
}

} // namespace

struct VideoWriter::Data {
    fs::path file;
    std::optional<Unnamed> written;
    glm::ivec2 size{0};
    cv::VideoWriter writer;
    cv::Mat picture;
    std::vector<std::int16_t> sound;
    int frames = 0;
};

VideoWriter::VideoWriter(fs::path file, glm::ivec2 size, double framesPerSecond) : data_(std::make_unique<Data>()) {
    checkSize(size);
    if (!(framesPerSecond >= 1.0 && framesPerSecond <= 240.0))
        throw InvalidInput("frame rate of the video", "it must be 1 to 240 frames a second",
                           "give a rate in that range");
    checkFile(file);
    data_->file = std::move(file);
    data_->written.emplace(data_->file);
    data_->size = size;
    data_->picture.create(size.y, size.x, CV_8UC3);
    const std::string name = data_->written->nameForEncoder();
    const auto opens = [&](const std::array<char, 4>& code) {
        return data_->writer.open(name, cv::CAP_FFMPEG, cv::VideoWriter::fourcc(code[0], code[1], code[2], code[3]),
                                  framesPerSecond, cv::Size(size.x, size.y));
    };
    const bool isOpen = opens({'a', 'v', 'c', '1'}) || opens({'m', 'p', '4', 'v'});
    data_->written->opened();
    if (isOpen) return;
    throw DeviceError(data_->file.string(), "no video encoder for MP4 could be started",
                      "install the packages libopencv-videoio406 and libavcodec59, or choose a smaller size");
}

VideoWriter::~VideoWriter() { data_->writer.release(); }

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

void VideoWriter::addSound(std::span<const std::int16_t> samples) {
    data_->sound.insert(data_->sound.end(), samples.begin(), samples.end());
}

int VideoWriter::frames() const noexcept { return data_->frames; }

void VideoWriter::finish() {
    if (data_->frames == 0)
        throw InvalidInput(data_->file.string(), "a video needs at least one frame", "make it longer");
    data_->writer.release();
    // The encoder keeps quiet about a disk that refuses; what counts is what can be read again.
    if (!holds(data_->written->content(), data_->frames, data_->size))
        failIncomplete(data_->file, data_->written->beside());
    if (std::ranges::any_of(data_->sound, [](std::int16_t sample) { return sample != 0; })) {
        Unnamed whole(data_->file);
        const std::string name = whole.nameForEncoder();
        addSoundTrack(data_->written->content(), data_->sound, kSoundRate, name);
        whole.opened();
        if (!holds(whole.content(), data_->frames, data_->size)) failIncomplete(data_->file, whole.beside());
        data_->written.emplace(std::move(whole));
    }
    if (const std::error_code error = data_->written->moveTo(data_->file))
        throw DeviceError(data_->file.string(), "cannot be written: " + error.message(),
                          "choose another place, or check its permissions");
}

glm::ivec2 evenSize(glm::ivec2 size) noexcept {
    return {std::max(kMinSide, size.x - size.x % 2), std::max(kMinSide, size.y - size.y % 2)};
}

} // namespace lumorph
