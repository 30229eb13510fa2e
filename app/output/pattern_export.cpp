#include "app/output/pattern_export.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <string>
#include <system_error>

#include "app/output/video_writer.h"
#include "calibration/capture/capture_camera.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kFrames = 10.0; ///< a second, of the film

std::string nameOf(std::size_t index, const std::string& words) {
    char number[16];
    std::snprintf(number, sizeof number, "%03zu_", index + 1);
    std::string name = number + words + ".png";
    std::ranges::replace(name, ' ', '-');
    return name;
}

/// Takes the folder away again unless it is done.
class NewFolder {
public:
    explicit NewFolder(const std::filesystem::path& path) : path_(path) {
        std::error_code error;
        if (std::filesystem::exists(path_, error) && !std::filesystem::is_empty(path_, error))
            throw InvalidInput("folder " + path_.string(), "it holds something", "name a new one");
        std::filesystem::create_directories(path_, error);
        if (error) throw DeviceError("folder " + path_.string(), error.message(), "name one that you may write");
    }
    ~NewFolder() {
        std::error_code error;
        if (!isDone_) std::filesystem::remove_all(path_, error);
    }
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;
    void setDone() { isDone_ = true; }

private:
    std::filesystem::path path_;
    bool isDone_ = false;
};

} // namespace

void writePatterns(const CaptureOrder& order, const std::filesystem::path& folder, double seconds,
                   const Progress& progress) {
    if (!(seconds >= 0.2 && seconds <= 60.0))
        throw InvalidInput("pace", std::to_string(seconds) + " seconds a pattern are not possible",
                           "choose between 0.2 and 60");
    const glm::ivec2 size(order.projector.width, order.projector.height);
    if (evenSize(size) != size)
        throw InvalidInput("projector", "a film has an even number of columns and rows",
                           "give the projector's own size");
    NewFolder made(folder);
    VideoWriter film(folder / "patterns.mp4", size, kFrames);
    const auto frames = static_cast<int>(std::lround(kFrames * seconds));
    std::string lines;
    for (std::size_t i = 0; i < order.images.size(); ++i) {
        progress.throwIfCancelled();
        const std::string words = wordsOf(order.images[i]);
        const Image image = imageOfGrey(drawPattern(order.images[i], order.projector));
        writePng(image, folder / nameOf(i, words));
        for (int frame = 0; frame < frames; ++frame) film.add(image);
        lines += words + "\n";
        progress.report(static_cast<double>(i + 1) / static_cast<double>(order.images.size()), words);
    }
    film.finish();
    writeFileAtomically(folder / "order.txt", std::as_bytes(std::span(lines)));
    made.setDone();
}

} // namespace lumorph
